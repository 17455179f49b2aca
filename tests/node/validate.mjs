// Prints what Khronos' validator says of each file named on the command line, as JSON.
import { readFile } from 'node:fs/promises';
import { validateBytes } from 'gltf-validator';

const reports = [];
for (const path of process.argv.slice(2)) {
  const report = await validateBytes(new Uint8Array(await readFile(path)), { maxIssues: 20 });
  reports.push({ issues: report.issues, info: report.info });
}
process.stdout.write(JSON.stringify(reports));
