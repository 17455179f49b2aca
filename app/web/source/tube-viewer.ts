/** `<script type="module" src="…/tube-viewer.js">` makes the element known to a page. */
import { TubeViewer } from "./viewer/element.ts";

export { TubeViewer };
export type { Status, TubeEvents } from "./viewer/events.ts";
export type { Thing, ThingName } from "./viewer/things.ts";

declare global {
  interface HTMLElementTagNameMap {
    "tube-viewer": TubeViewer;
  }
}

customElements.define("tube-viewer", TubeViewer);
