// usage: node workflow.mjs FILE
// Prints as JSON what GitHub's schema of workflows has against the file: a list, empty for a sound one.
import { readFileSync } from "node:fs";
import { validateWorkflow } from "@action-validator/core";

const { errors } = validateWorkflow(readFileSync(process.argv[2], "utf8"));
console.log(JSON.stringify(errors));
