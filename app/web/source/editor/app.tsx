import { ReactFlowProvider, useReactFlow, type Edge } from "@xyflow/react";
import { useCallback, useEffect, useMemo, useRef, useState, type ReactElement } from "react";
import { Client, type ProgramDocument } from "tubeloom-client";
import { TubePreview, useTubeloom, type Clearance, type Frame, type ThingName } from "tubeloom-react-flow";
import { Canvas } from "./canvas.tsx";
import { countChosen, joinChosen, removed, renamed } from "./commands.ts";
import { example } from "./example.ts";
import { added, ORIGIN, type AppNode } from "./graph.ts";
import { Header } from "./header.tsx";
import type { Kind } from "./kinds.ts";
import { Editing, keyOfEnd } from "./nodes.tsx";
import { download, Opening } from "./opening.tsx";
import { usePaints } from "./paints.ts";
import { Palette } from "./palette.tsx";
import { graphOf, keptSelection, selected, selectionOf } from "./showing.ts";
import { StatusLine } from "./status.tsx";
import { useShortcuts } from "./shortcuts.ts";
import { useTheme } from "./theme.ts";

const OPTIONS = { origin: ORIGIN };
const FRAME: Frame = { name: "Grandparents" };

interface EditorProps {
  id: string;
  isNew: boolean;
  apiKey: string | undefined;
}

/** The editor, and the picture of its program beside it. */
export function App(props: EditorProps): ReactElement {
  return (
    <ReactFlowProvider>
      <Editor {...props} />
    </ReactFlowProvider>
  );
}

function Editor({ id, isNew, apiKey }: EditorProps): ReactElement {
  // The link itself waits and tries again; a client without patience lets it tell so at once.
  const client = useMemo(
    () => new Client(location.origin, { patience: 0, ...(apiKey && { key: apiKey }) }),
    [apiKey],
  );
  const flow = useReactFlow<AppNode, Edge>();
  const { theme, switchTheme } = useTheme();
  const [graph, setGraph] = useState(example);
  const [frame, setFrame] = useState(FRAME);
  const [picked, setPicked] = useState<ReadonlySet<string>>(new Set());
  const [renaming, setRenaming] = useState<string | undefined>();
  const [clearance, setClearance] = useState<Clearance | undefined>();
  const [isOpening, setIsOpening] = useState(false);
  const [trouble, setTrouble] = useState("");
  const isShown = useRef(false);
  const [isComing, setIsComing] = useState(false);

  const show = useCallback(
    (program: ProgramDocument) => {
      setIsComing(!isShown.current);
      void graphOf(program, client).then(
        (found) => {
          setIsComing(false);
          const { items: _, hyperedges: __, ...rest } = program;
          setFrame(rest);
          setGraph((now) => keptSelection(now, found));
          if (!isShown.current) setTimeout(() => void flow.fitView({ padding: 0.15, maxZoom: 1 }), 50);
          isShown.current = true;
        },
        (error: unknown) => {
          setIsComing(false);
          setTrouble(error instanceof Error ? error.message : String(error));
        },
      );
    },
    [flow, client],
  );
  const link = useTubeloom({
    client,
    id,
    isNew,
    nodes: graph.nodes,
    edges: graph.edges,
    options: OPTIONS,
    frame,
    onProgram: show,
  });
  const { undo, redo, beginGesture, endGesture } = link;
  const paints = usePaints(client, id, graph, link.status === "saved");

  const names = useMemo(() => selectionOf(graph), [graph]);
  const selection = useStable(names);
  const select = useCallback((things: readonly ThingName[]) => setGraph((now) => selected(now, things)), []);
  const join = useCallback(() => {
    setGraph((now) => joinChosen(now, picked));
    setPicked(new Set());
  }, [picked]);
  const remove = useCallback(() => setGraph(removed), []);
  const add = (kind: Kind) => {
    const { x = 0, y = 0, width = 0, height = 0 } = document.querySelector(".canvas")?.getBoundingClientRect() ?? {};
    const near = flow.screenToFlowPosition({ x: x + width / 2, y: y + height / 2 });
    setGraph((now) => added(now, kind, near).graph);
  };
  const startRename = useCallback(
    () => setRenaming(graph.nodes.find((node) => node.selected)?.id),
    [graph.nodes],
  );
  const onGesture = useCallback(
    (isOn: boolean) => (isOn ? beginGesture : endGesture)(),
    [beginGesture, endGesture],
  );
  useShortcuts({ undo, redo, join, rename: startRename, leave: () => setPicked(new Set()) });
  useEffect(() => {
    document.title = `${frame.name || id} · Tubeloom editor`;
  }, [frame.name, id]);

  const acts = useMemo(
    () => ({
      renamed: renaming,
      picked,
      startRename: setRenaming,
      rename: (node: string, label: string | undefined) => {
        if (label !== undefined) setGraph((now) => renamed(now, node, label.trim()));
        setRenaming(undefined);
        document.querySelector<HTMLElement>(`.react-flow__node[data-id="${CSS.escape(node)}"]`)?.focus();
      },
      pick: (node: string, handle: string) => {
        const key = keyOfEnd(node, handle);
        setPicked((now) => (now.has(key) ? new Set([...now].filter((each) => each !== key)) : new Set([...now, key])));
      },
    }),
    [renaming, picked],
  );

  const read = (file: File) => {
    setTrouble("");
    isShown.current = false;
    file
      .text()
      .then((text) => {
        const program = JSON.parse(text) as ProgramDocument;
        // The service judges the document, before it takes the place of what is here.
        return client.layout(program).then(() => show(program));
      })
      .catch((error: unknown) => setTrouble(error instanceof Error ? error.message : String(error)));
  };

  const isOpen = isNew || (link.revision > 0 && !isComing);
  const isAnything = graph.nodes.some((node) => node.selected) || graph.edges.some((edge) => edge.selected);
  return (
    <>
      <Header
        name={frame.name ?? ""}
        onName={(name) => setFrame((now) => ({ ...now, name }))}
        theme={theme}
        onTheme={switchTheme}
        commands={{
          undo: link.canUndo ? undo : undefined,
          redo: link.canRedo ? redo : undefined,
          join: countChosen(graph, picked) > 1 ? join : undefined,
          rename: graph.nodes.some((node) => node.selected) ? startRename : undefined,
          remove: isAnything ? remove : undefined,
          open: () => setIsOpening(true),
          save: () => download(`${frame.name || id}.json`, JSON.stringify(link.program, null, 2)),
        }}
      />
      <main>
        <Palette onAdd={add} />
        <section className={isOpen ? "canvas" : "canvas waiting"} aria-label="Editor">
          <Editing.Provider value={acts}>
            <Canvas graph={graph} setGraph={setGraph} paints={paints} colorMode={theme} onGesture={onGesture} />
          </Editing.Provider>
        </section>
        <section className="preview" aria-label="In three dimensions">
          <TubePreview
            stored={link.revision > 0 ? id : undefined}
            apiKey={apiKey}
            selection={selection}
            onSelect={select}
            onClearance={setClearance}
            theme={theme}
          />
        </section>
      </main>
      <StatusLine link={link} graph={graph} clearance={clearance} trouble={trouble} />
      {isOpening ? <Opening onFile={read} onClose={() => setIsOpening(false)} /> : null}
    </>
  );
}

/** The same array as long as it names the same things. */
function useStable(names: readonly ThingName[]): readonly ThingName[] {
  const kept = useRef(names);
  if (JSON.stringify(kept.current) !== JSON.stringify(names)) kept.current = names;
  return kept.current;
}
