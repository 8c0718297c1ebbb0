// Prints what the Khronos validator says of a GLB file, as JSON, for check_export.py.
import { createRequire } from "node:module";
import { readFileSync } from "node:fs";
import { join } from "node:path";

const [file, modules] = process.argv.slice(2);
const validator = createRequire(join(modules, "index.js"))("gltf-validator");
const report = await validator.validateBytes(new Uint8Array(readFileSync(file)));
const { numErrors, numWarnings, messages } = report.issues;
console.log(JSON.stringify({ errors: numErrors, warnings: numWarnings, first: messages[0] ?? null }));
