/** One server-sent event. */
export interface ServerEvent {
  name: string;
  data: string;
}

/** The events of an answer, as they come. */
export async function* eventsOf(response: Response): AsyncGenerator<ServerEvent> {
  if (response.body === null) return;
  const reader = response.body.pipeThrough(new TextDecoderStream()).getReader();
  let [chunks, isEnded] = [[] as string[], false];
  try {
    while (!isEnded) {
      const { done, value = "" } = await reader.read();
      isEnded = done;
      chunks.push(value);
      // A picture comes in many chunks; looking for its end once is enough.
      if (!isEnded && !value.includes("\n")) continue;
      const blocks = chunks.join("").replaceAll("\r\n", "\n").split("\n\n");
      chunks = isEnded ? [] : [blocks.pop() ?? ""];
      for (const block of blocks) if (block.trim() !== "") yield eventOf(block);
    }
  } finally {
    await reader.cancel().catch(() => undefined);
  }
}

function eventOf(block: string): ServerEvent {
  let name = "message";
  const data: string[] = [];
  for (const line of block.split("\n")) {
    if (line.startsWith("event:")) name = line.slice(6).trim();
    else if (line.startsWith("data:")) data.push(line.slice(5).replace(/^ /, ""));
  }
  return { name, data: data.join("\n") };
}
