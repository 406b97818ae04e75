// Builds the page: view_page/src -> simkit_view/view/page. `node build.mjs [FOLDER]` writes to another folder.
import { build } from 'esbuild';
import { copyFile, mkdir, readFile, writeFile } from 'node:fs/promises';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const here = dirname(fileURLToPath(import.meta.url));
const out = process.argv[2] ?? join(here, '../simkit_view/view/page');
await mkdir(out, { recursive: true });
const script = await build({
  entryPoints: { app: join(here, 'src/main.js') },
  bundle: true,
  metafile: true,
  minify: true,
  format: 'esm',
  target: 'es2022',
  legalComments: 'none',
  outdir: out,
});
const style = await build({
  entryPoints: { app: join(here, 'src/page.css') }, bundle: true, metafile: true, minify: true, legalComments: 'none', outdir: out,
});
for (const name of ['index.html', 'icon.svg']) await copyFile(join(here, 'src', name), join(out, name));
const inputs = [script, style].flatMap((built) => Object.keys(built.metafile.inputs));
const bundled = new Set(inputs.map((path) => path.match(/.*node_modules\/((?:@[^/]+\/)?[^/]+)\//)?.[1]).filter(Boolean));
const licences = [];
for (const name of [...bundled].sort()) {
  const { version, license } = JSON.parse(await readFile(join(here, 'node_modules', name, 'package.json'), 'utf8'));
  const text = (await readFile(join(here, 'node_modules', name, 'LICENSE'), 'utf8')).trim();
  licences.push(`${name} ${version} (${license})\n\n${text}\n`);
}
await writeFile(join(out, 'LICENSES.txt'), `The page contains these libraries.\n\n${licences.join('\n----\n\n')}`);
