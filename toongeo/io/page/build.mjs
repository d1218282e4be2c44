// node build.mjs [FOLDER]: the viewer and the landmark editor, each with three.js in one script, viewer.js and editor.js,
// in FOLDER (default: here).
// The same bytes each time: versions are pinned by package-lock.json, and tests compare them with what is committed.
import { readFile } from 'node:fs/promises';
import { fileURLToPath } from 'node:url';
import { dirname, join } from 'node:path';
import { build } from 'esbuild';

const here = dirname(fileURLToPath(import.meta.url));
const three = join(here, 'node_modules', 'three');
const { version } = JSON.parse(await readFile(join(three, 'package.json'), 'utf8'));
const licence = await readFile(join(three, 'LICENSE'), 'utf8');

// The editor is a module, since notebooks import it.
for (const [entry, name, format] of [['src/main.js', 'viewer.js', 'iife'], ['src/editor/main.js', 'editor.js', 'esm']]) {
  await build({
    absWorkingDir: here,
    entryPoints: [entry],
    outfile: join(process.argv[2] ?? here, name),
    bundle: true,
    minify: true,
    format,
    target: 'es2022',
    charset: 'ascii',
    legalComments: 'inline',
    banner: { js: `/*!\nThis script contains three.js ${version}, https://threejs.org\n\n${licence.trim()}\n*/` },
  });
}
