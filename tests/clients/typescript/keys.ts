// Asks with a wrong key, and one where nobody listens.
import { Client, Problem } from "tubeloom-client";

declare const process: { argv: string[] };

const [, , url, nobody] = process.argv;

async function nameOf(work: Promise<unknown>): Promise<string> {
  try {
    await work;
  } catch (error) {
    return error instanceof Problem ? String(error.status) : (error as Error).name;
  }
  return "an answer";
}

console.log(
  JSON.stringify([
    await nameOf(new Client(url, { key: "wrong" }).layout({ items: [] })),
    await nameOf(new Client(nobody, { patience: 0.5 }).layout({ items: [] })),
  ]),
);
