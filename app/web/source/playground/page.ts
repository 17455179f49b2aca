/** The element of the page that a selector names. */
export function part<Kind extends HTMLElement>(selector: string, kind: new () => Kind): Kind {
  const found = document.querySelector(selector);
  if (!(found instanceof kind)) throw new Error(`The page has lost its ${selector}.`);
  return found;
}

/** A new element with a class, a text and children. */
export function make<Name extends keyof HTMLElementTagNameMap>(
  name: Name,
  { className = "", text = "" } = {},
  ...children: (HTMLElement | string)[]
): HTMLElementTagNameMap[Name] {
  const made = document.createElement(name);
  if (className) made.className = className;
  if (text) made.textContent = text;
  made.append(...children);
  return made;
}

/** Says something to those who do not see the page. */
export function say(text: string): void {
  part("#live", HTMLElement).textContent = text;
}

/** Shows what went wrong, until it is dismissed or something else is worth telling. */
export function warn(text: string | undefined): void {
  const notice = part("#notice", HTMLElement);
  part("#notice p", HTMLElement).textContent = text ?? "";
  notice.hidden = text === undefined;
}

/** A function that acts once nothing has been asked of it for a while. */
export function calm<Given extends unknown[]>(
  act: (...given: Given) => void,
  milliseconds: number,
): (...given: Given) => void {
  let timer: ReturnType<typeof setTimeout> | undefined;
  return (...given) => {
    clearTimeout(timer);
    timer = setTimeout(() => act(...given), milliseconds);
  };
}
