import type { ReactElement } from "react";
import { JUNCTION, type Clearance, type LinkState } from "tubeloom-react-flow";
import type { Graph } from "./graph.ts";

interface StatusProps {
  link: LinkState;
  graph: Graph;
  clearance: Clearance | undefined;
  trouble: string;
}

const WORDS: Record<LinkState["status"], string> = {
  connecting: "Connecting …",
  saved: "Saved",
  sending: "Sending …",
  offline: "Offline",
  refused: "Not saved",
};

/** Whether all is saved, and whether tubes keep their distance. */
export function StatusLine({ link, graph, clearance, trouble }: StatusProps): ReactElement {
  const hyperedges = graph.nodes.filter(({ type }) => type === JUNCTION).length;
  return (
    <footer className="status">
      <span role="status" data-status={link.status}>
        <i aria-hidden="true" />
        {WORDS[link.status]}
        {link.detail ? `: ${link.detail}` : ""}
      </span>
      {trouble ? <span role="alert">{trouble}</span> : null}
      <span className="numbers">
        {graph.nodes.length - hyperedges} items, {hyperedges} hyperedges · revision {link.revision}
      </span>
      <span className="clearance" data-conflicts={clearance?.conflicts.length ?? 0}>
        {verdictOf(clearance)}
      </span>
    </footer>
  );
}

function verdictOf(clearance: Clearance | undefined): string {
  if (clearance === undefined) return "";
  const { conflicts, certified, minimum } = clearance;
  if (conflicts.length > 0) return `${conflicts.length} ${conflicts.length === 1 ? "place" : "places"} too close`;
  if (!certified) return "Distances are not proven";
  return minimum == null ? "Nothing touches" : `Nothing touches: ${minimum.toFixed(2)} apart at least`;
}
