// Writes what happens to a stored program, a line of JSON each, until it is deleted.
import { Client } from "tubeloom-client";

declare const process: { argv: string[] };

const [, , url, program = ""] = process.argv;
for await (const happening of new Client(url, { patience: 90 }).program(program).watch()) {
  console.log(JSON.stringify(happening));
}
