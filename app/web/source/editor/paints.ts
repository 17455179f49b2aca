import { useEffect, useState } from "react";
import type { Client } from "tubeloom-client";
import { JUNCTION } from "tubeloom-react-flow";
import type { Graph } from "./graph.ts";

const NONE: ReadonlyMap<string, string> = new Map();

/**
 * The colours that the service has chosen for hyperedges of the stored program that have none of
 * their own, by their ids: asked for once all is saved, and again where there are others.
 */
export function usePaints(client: Client, id: string, graph: Graph, isSaved: boolean): ReadonlyMap<string, string> {
  const [paints, setPaints] = useState(NONE);
  const bare = graph.nodes.filter(({ type, data }) => type === JUNCTION && data["color"] === undefined);
  const isLacking = bare.some((junction) => !paints.has(junction.id));
  useEffect(() => {
    if (!isSaved || !isLacking) return undefined;
    let isLeft = false;
    client
      .program(id)
      .layout()
      .then(
        ({ hyperedges }) => {
          if (!isLeft) setPaints(new Map(hyperedges.map((each) => [each.id, each.color])));
        },
        // The lines are right without; trouble with the service shows where the program is saved.
        () => undefined,
      );
    return () => {
      isLeft = true;
    };
  }, [client, id, isSaved, isLacking]);
  return paints;
}
