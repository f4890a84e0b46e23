// As much of XML as Doxygen writes: elements, attributes, text, five entities. {name, attributes, children}; text is a
// string.
const entities = {lt: '<', gt: '>', amp: '&', quot: '"', apos: "'"};
const decode = text =>
  text.replace(/&(?:#(\d+)|#x([0-9a-f]+)|(\w+));/gi, (all, decimal, hex, name) =>
    decimal
      ? String.fromCodePoint(Number(decimal))
      : hex
        ? String.fromCodePoint(parseInt(hex, 16))
        : (entities[name] ?? special(name)),
  );
const special = name => ({nonbreakablespace: '\u00a0'})[name] ?? `&${name};`;

export function parseXml(text) {
  const root = {name: '', attributes: {}, children: []},
    open = [root];
  const pattern = /<\?[^>]*\?>|<!--[\s\S]*?-->|<(\/?)([\w:.-]+)((?:\s+[\w:.-]+="[^"]*")*)\s*(\/?)>|[^<]+/g;
  for (const [all, closes, name, attributes, empty] of text.matchAll(pattern)) {
    const parent = open.at(-1);
    if (name === undefined) {
      if (!all.startsWith('<')) parent.children.push(decode(all));
    } else if (closes) {
      if (open.pop().name !== name) throw new Error(`</${name}> closes another element`);
    } else {
      const element = {name, attributes: {}, children: []};
      for (const [, key, value] of attributes.matchAll(/([\w:.-]+)="([^"]*)"/g))
        element.attributes[key] = decode(value);
      parent.children.push(element);
      if (!empty) open.push(element);
    }
  }
  return root.children.find(child => child.name);
}

export const all = (element, name) => element.children.filter(child => child.name === name);
export const one = (element, name) => element.children.find(child => child.name === name);
export const textOf = element =>
  element === undefined ? '' : typeof element === 'string' ? element : element.children.map(textOf).join('');
