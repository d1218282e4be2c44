// node validate.mjs FILE... : the Khronos validator's verdict on each GLB, as a JSON array on stdout.
import { readFile } from 'node:fs/promises';
import validator from 'gltf-validator';

const verdicts = [];
for (const file of process.argv.slice(2)) {
  const bytes = new Uint8Array(await readFile(file));
  const { issues, info } = await validator.validateBytes(bytes, { uri: file, maxIssues: 200 });
  verdicts.push({
    file,
    errors: issues.numErrors,
    warnings: issues.numWarnings,
    infos: issues.numInfos,
    hints: issues.numHints,
    messages: issues.messages,
    info,
  });
}
console.log(JSON.stringify(verdicts));
