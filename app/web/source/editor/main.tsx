import { createRoot } from "react-dom/client";
import "../tube-viewer.ts";
import { App } from "./app.tsx";

const query = new URLSearchParams(location.search);
const given = query.get("program");
const id = given || freshId();
if (!given) {
  query.set("program", id);
  history.replaceState(null, "", `?${query.toString()}`);
}

const place = document.querySelector("#editor");
if (place) createRoot(place).render(<App id={id} isNew={!given} />);

/** Pages that do not come over TLS have no `randomUUID`. */
function freshId(): string {
  const bytes = [...crypto.getRandomValues(new Uint8Array(5))];
  return `flow-${bytes.map((byte) => byte.toString(36).padStart(2, "0")).join("")}`;
}
