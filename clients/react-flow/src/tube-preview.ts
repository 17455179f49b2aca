import { createElement, useEffect, useRef, type ReactElement } from "react";

/** Names an item or a hyperedge of the program. */
export interface ThingName {
  shows: "item" | "hyperedge";
  id: string;
}

/** What is proven of distances between tubes, and between tubes and items. */
export interface Clearance {
  certified: boolean;
  minimum?: number | null;
  conflicts: readonly unknown[];
}

interface ViewerElement extends HTMLElement {
  key: string | undefined;
  selection: readonly ThingName[];
}

export interface TubePreviewProps {
  /** The id of the stored program that is shown, and followed; undefined as long as there is none. */
  stored: string | undefined;
  selection?: readonly ThingName[];
  onSelect?: (things: readonly ThingName[]) => void;
  onClearance?: (clearance: Clearance) => void;
  theme?: "light" | "dark" | undefined;
  /** Where the service wants a key; the viewer sends it to that service alone. */
  apiKey?: string | undefined;
  /** Further attributes of `<tube-viewer>`, such as `service`, `labels` and `motion`. */
  attributes?: Readonly<Record<string, string>>;
}

const NOTHING: readonly ThingName[] = [];

/** `<tube-viewer>` in React. The page loads the element itself: `tube-viewer.js` of the service. */
export function TubePreview(props: TubePreviewProps): ReactElement {
  const { stored, selection = NOTHING, onSelect, onClearance, theme, apiKey, attributes } = props;
  const viewer = useRef<ViewerElement>(null);
  const heard = useRef({ onSelect, onClearance });
  heard.current = { onSelect, onClearance };

  useEffect(() => {
    const element = viewer.current;
    if (element === null) return;
    const select = (event: Event) => {
      heard.current.onSelect?.((event as CustomEvent<{ things: ThingName[] }>).detail.things);
    };
    const clearance = (event: Event) => {
      heard.current.onClearance?.((event as CustomEvent<{ clearance: Clearance }>).detail.clearance);
    };
    element.addEventListener("tube-select", select);
    element.addEventListener("tube-clearance", clearance);
    return () => {
      element.removeEventListener("tube-select", select);
      element.removeEventListener("tube-clearance", clearance);
    };
  }, []);

  useEffect(() => {
    // Before the element is known, this would not reach it.
    void customElements.whenDefined("tube-viewer").then(() => {
      const element = viewer.current;
      if (element !== null && element.key !== apiKey) element.key = apiKey;
    });
  }, [apiKey]);

  useEffect(() => {
    // What is not shown yet cannot be selected: it is tried again with what comes.
    const element = viewer.current;
    if (element === null) return;
    const select = () => {
      element.selection = selection;
    };
    select();
    element.addEventListener("tube-load", select);
    return () => element.removeEventListener("tube-load", select);
  }, [selection]);

  return createElement("tube-viewer", { ref: viewer, stored, theme, toolbar: "", conflicts: "", ...attributes });
}
