// Changes a program while the service is away; writes each status as a line.
import { Client, type ProgramDocument } from "tubeloom-client";
import { Link } from "./link.js";

declare const process: { argv: string[] };

const url = process.argv[2] ?? "";
let told: string = "";
const link = new Link(new Client(url, { patience: 0 }), "away", {
  state: ({ status }) => {
    if (status !== told) console.log(status);
    told = status;
  },
  program: () => undefined,
});

function at(x: number): ProgramDocument {
  return { items: [{ id: "a", position: [x, 0, 0.25] }] };
}

async function isThere(): Promise<boolean> {
  return fetch(`${url}/healthz`).then((response) => response.ok, () => false);
}

async function until(status: string): Promise<void> {
  while (told !== status) await new Promise((resolve) => setTimeout(resolve, 20));
}

await link.open(at(0), true);
while (await isThere()) await new Promise((resolve) => setTimeout(resolve, 20));
link.send(at(1));
link.send(at(2));
await until("offline");
link.send(at(3));
await until("saved");
link.close();
