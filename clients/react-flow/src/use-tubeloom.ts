import { useCallback, useEffect, useMemo, useRef, useState } from "react";
import type { Client, ProgramDocument } from "tubeloom-client";
import { isSame, type FlowEdge, type FlowNode, type FlowOptions } from "./graph.js";
import { Link, type LinkState } from "./link.js";
import { programOf, type Frame } from "./program-of.js";

export interface TubeloomOptions {
  client: Client;
  /** The id of the stored program. */
  id: string;
  /** The id was just made up: there is no such program yet. */
  isNew?: boolean;
  nodes: readonly FlowNode[];
  edges: readonly FlowEdge[];
  options?: FlowOptions;
  /** What the program says beside items and hyperedges. */
  frame?: Frame;
  /** Show this program instead: it was opened, undone or redone, or somebody else has changed it. */
  onProgram: (program: ProgramDocument) => void;
}

export interface Tubeloom extends LinkState {
  program: ProgramDocument;
  undo: () => void;
  redo: () => void;
  /** Call when dragging begins and ends: all that comes between is one change to undo. */
  beginGesture: () => void;
  endGesture: () => void;
}

const FIRST: LinkState = { status: "connecting", detail: "", revision: 0, canUndo: false, canRedo: false };

/**
 * Keeps a stored program like the graph that React Flow shows. A program of that id is opened if there
 * is one; otherwise it is made of the graph.
 */
export function useTubeloom(of: TubeloomOptions): Tubeloom {
  const { client, id, isNew = false, nodes, edges, options, frame, onProgram } = of;
  const [state, setState] = useState(FIRST);
  const program = useMemo(
    () => programOf(nodes, edges, { ...options, ...(frame && { frame }) }),
    [nodes, edges, options, frame],
  );
  const link = useRef<Link | undefined>(undefined);
  const latest = useRef({ program, onProgram, isNew });
  const shown = useRef(program);
  latest.current = { program, onProgram, isNew };

  useEffect(() => {
    setState(FIRST);
    shown.current = latest.current.program;
    const opened = new Link(client, id, {
      state: setState,
      program: (found) => latest.current.onProgram(found),
    });
    link.current = opened;
    void opened.open(latest.current.program, latest.current.isNew);
    return () => {
      link.current = undefined;
      opened.close();
    };
  }, [client, id]);

  useEffect(() => {
    // Selecting changes nodes too, but not what they mean.
    if (isSame(shown.current, program)) return;
    shown.current = program;
    link.current?.send(program);
  }, [program]);

  const undo = useCallback(() => link.current?.undo(), []);
  const redo = useCallback(() => link.current?.redo(), []);
  const beginGesture = useCallback(() => link.current?.beginGesture(), []);
  // The end of a drag is told before where it ended is rendered, and so sent.
  const endGesture = useCallback(() => {
    requestAnimationFrame(() => setTimeout(() => link.current?.endGesture()));
  }, []);
  return { ...state, program, undo, redo, beginGesture, endGesture };
}
