// node validate.mjs [--strict] FILE... : the Khronos validator's verdict on each GLB, as a JSON array on stdout.
// --strict: exit code 1 if there is an error or a warning.
import { readFile } from 'node:fs/promises';
import validator from 'gltf-validator';

const verdicts = [];
const strict = process.argv.includes('--strict');
for (const file of process.argv.slice(2).filter((argument) => argument !== '--strict')) {
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
if (strict && verdicts.some((verdict) => verdict.errors + verdict.warnings > 0)) process.exitCode = 1;
