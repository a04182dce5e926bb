// SPDX-License-Identifier: GPL-3.0-or-later
// node check_glb.mjs FILE VALIDATOR_FOLDER: prints the validator's issues; exit code 1 when there is an error.
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import path from 'node:path';

const [file, tools] = process.argv.slice(2);
const require = createRequire(path.resolve(tools, 'package.json'));
const validator = require('gltf-validator');
const options = {
  uri: path.basename(file),
  externalResourceFunction: (uri) => Promise.resolve(new Uint8Array(readFileSync(path.join(path.dirname(file), uri)))),
};
const report = await validator.validateBytes(new Uint8Array(readFileSync(file)), options);
console.log(JSON.stringify(report.issues, null, 1));
process.exit(report.issues.numErrors > 0 ? 1 : 0);
