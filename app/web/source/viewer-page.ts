import { admitted, askWhereWanted, authorization, heedKey } from "./key.ts";
import "./tube-viewer.ts";

const query = new URLSearchParams(location.search);
const viewer = document.querySelector("tube-viewer");
const none = document.querySelector<HTMLElement>("#none");
const programs = document.querySelector<HTMLSelectElement>("#programs");

/** Attributes of the element that the page's address may give. */
const ATTRIBUTES = ["stored", "src", "motion", "stereo", "others", "labels", "shadows", "theme"];

if (viewer && none && programs) {
  for (const name of ATTRIBUTES) {
    const value = query.get(name);
    if (value !== null) viewer.setAttribute(name, value);
  }
  viewer.setAttribute("conflicts", "");
  askWhereWanted();
  heedKey((key) => {
    if (key !== viewer.key) viewer.key = key;
  });
  const isEmpty = !query.get("stored") && !query.get("src");
  viewer.hidden = isEmpty;
  none.hidden = !isEmpty;
  if (isEmpty) void offer(programs);
  else document.title = `${query.get("stored") ?? query.get("src")} · Tubeloom viewer`;
}

/** Lists the stored programs, to choose one. */
async function offer(choices: HTMLSelectElement): Promise<void> {
  choices.append(new Option("Choose one …", ""));
  choices.addEventListener("change", () => {
    if (choices.value) location.search = `?stored=${encodeURIComponent(choices.value)}`;
  });
  await admitted();
  const response = await fetch("/v1/programs?limit=100", { headers: authorization() });
  if (!response.ok) return;
  const { programs: found } = (await response.json()) as { programs: { id?: string; program?: string }[] };
  for (const each of found) {
    const id = each.id ?? each.program;
    if (id) choices.append(new Option(id, id));
  }
}
