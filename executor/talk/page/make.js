// Making elements.

/** An element with properties (`data` and `aria` hold attributes) and children. */
export function make(tag, {data = {}, aria = {}, on = {}, ...properties} = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) element[name] = value;
  for (const [name, value] of Object.entries(data)) element.dataset[name] = value;
  for (const [name, value] of Object.entries(aria)) element.setAttribute(`aria-${name}`, value);
  for (const [name, does] of Object.entries(on)) element.addEventListener(name, does);
  element.append(...children.filter((each) => each !== null && each !== undefined));
  return element;
}

/** Change a text only where it is another: what is read aloud is not read again. */
export function setText(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

/** Rebuild an element's children only when what they are made from has changed. */
export function rebuild(element, key, children) {
  const text = JSON.stringify(key);
  if (element.made === text) return;
  element.made = text;
  element.replaceChildren(...children());
}
