// SPDX-License-Identifier: GPL-3.0-or-later
// Usage: node validate_gltf.cjs FILE. Runs the Khronos validator; prints its errors and warnings.
// Exit code 0: no errors, 1: errors, 77: the npm package gltf-validator is not installed.
const fs = require("fs");
const path = require("path");
const {execSync} = require("child_process");

function validator() {
  const places = [__dirname, process.cwd()];
  try {
    places.push(path.join(execSync("npm root -g", {stdio: ["ignore", "pipe", "ignore"]}).toString().trim(), ".."));
  } catch (error) {
    // No npm: only the folders above are searched.
  }
  try {
    return require(require.resolve("gltf-validator", {paths: places}));
  } catch (error) {
    process.stderr.write("gltf-validator is not installed\n");
    process.exit(77);
  }
}

const file = process.argv[2];
validator()
  .validateBytes(new Uint8Array(fs.readFileSync(file)), {maxIssues: 100})
  .then((report) => {
    const counts = report.issues;
    for (const issue of counts.messages) {
      if (issue.severity <= 1) console.log(`${issue.severity === 0 ? "error" : "warning"} ${issue.pointer}: ${issue.message}`);
    }
    console.log(`${counts.numErrors} errors, ${counts.numWarnings} warnings, ${counts.numInfos} infos`);
    process.exit(counts.numErrors === 0 ? 0 : 1);
  })
  .catch((error) => {
    console.log(String(error));
    process.exit(1);
  });
