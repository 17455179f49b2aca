import { createRoot } from "react-dom/client";
import { admitted, askForKey, keyOf } from "../key.ts";
import "../tube-viewer.ts";
import { App } from "./app.tsx";
import { wearTheme } from "./theme.ts";

const query = new URLSearchParams(location.search);
const given = query.get("program");
const id = given || freshId();
if (!given) {
  query.set("program", id);
  history.replaceState(null, "", `?${query.toString()}`);
}

wearTheme();
await admitted();
// A key may end while one works; with another one, all is fetched anew.
addEventListener("tube-problem", (event) => {
  const { problem } = (event as CustomEvent<{ problem: { status: number } }>).detail;
  if (problem.status === 401) void askForKey().then((isGiven) => isGiven && location.reload());
});
const place = document.querySelector("#editor");
if (place) createRoot(place).render(<App id={id} isNew={!given} apiKey={keyOf()} />);

/** Pages that do not come over TLS have no `randomUUID`. */
function freshId(): string {
  const bytes = [...crypto.getRandomValues(new Uint8Array(5))];
  return `flow-${bytes.map((byte) => byte.toString(36).padStart(2, "0")).join("")}`;
}
