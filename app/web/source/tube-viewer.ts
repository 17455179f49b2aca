/** `<script type="module" src="…/tube-viewer.js">` makes the element known to a page. */
export { TubeViewer } from "./viewer/element.ts";
export type { Status, TubeEvents } from "./viewer/events.ts";
export type { Thing, ThingName } from "./viewer/things.ts";
