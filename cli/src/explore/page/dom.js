// Elements, numbers as people read them, and nothing that reads markup from a text: names and messages are texts of whoever wrote the model.

const SVG = 'http://www.w3.org/2000/svg';

export const byId = (id) => document.getElementById(id);

function made(element, properties, children) {
  for (const [name, value] of Object.entries(properties)) {
    if (value === undefined || value === null || value === false) continue;
    if (name.startsWith('on')) element.addEventListener(name.slice(2), value);
    else if (name === 'text') element.textContent = value;
    else element.setAttribute(name, value);
  }
  element.append(...children.filter((child) => child !== null && child !== undefined));
  return element;
}

export function el(name, properties = {}, ...children) {
  return made(document.createElement(name), properties, children);
}

export function svg(name, properties = {}, ...children) {
  return made(document.createElementNS(SVG, name), properties, children);
}

// A number without digits that mean nothing.
export function short(value, digits = 5) {
  if (value === null || !Number.isFinite(value)) return 'not known';
  return String(Number(value.toPrecision(digits)));
}

// A number that somebody has written, or NaN.
export function written(text) {
  const trimmed = text.trim().replace(',', '.');
  return trimmed === '' ? NaN : Number(trimmed);
}

export function inUnit(text, unit) {
  return unit ? `${text} [${unit}]` : text;
}
