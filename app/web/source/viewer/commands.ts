import type { TubeViewer } from "./element.ts";
import type { ToolbarCommands } from "./toolbar.ts";

/** What buttons and keys do to a viewer; `clear` selects nothing any more. */
export function commandsOf(viewer: TubeViewer, clear: () => void, nameOf: () => string): ToolbarCommands {
  return {
    fit: () => viewer.fit(),
    look: (view) => viewer.look(view),
    clear,
    toggleOthers: () => toggle(viewer, "others", "hide"),
    toggleMotion: () => toggle(viewer, "motion", "sway"),
    stereo: (kind) => viewer.setAttribute("stereo", kind),
    save: () => void save(viewer, nameOf() || "tubeloom"),
    headset: () => void viewer.enterHeadset(),
  };
}

async function save(viewer: TubeViewer, name: string): Promise<void> {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(await viewer.exportPicture());
  link.download = `${name}.png`;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

function toggle(viewer: TubeViewer, attribute: string, value: string): void {
  if (viewer.getAttribute(attribute) === value) viewer.removeAttribute(attribute);
  else viewer.setAttribute(attribute, value);
}
