// What can be taken along: files, lines, a link; and curves that are pinned to be compared.

import { chart, draw } from './chart.js';
import { byId, el } from './dom.js';
import { ask, Refused } from './net.js';
import { names, progress, report, request, session, status } from './session.js';
import { state, toHash } from './state.js';

export function pin() {
  if (!chart.curve) return;
  const used = chart.pins.map((own) => own.colour);
  const colour = [0, 1, 2, 3, 4].find((candidate) => !used.includes(candidate)) ?? chart.pins.length % 5;
  const values = names().filter((name) => name !== chart.curve.varied).map((name) => `${name} ${chart.curve.values[name]}`);
  chart.pins.push({ curve: chart.curve, colour, label: `${session.declared.name}: ${values.join(', ')}` });
  showPins();
}

export function showPins() {
  byId('unpin').hidden = chart.pins.length === 0;
  byId('pins').replaceChildren(...chart.pins.map((own, index) => {
    const swatch = el('span', { class: 'swatch' });
    swatch.style.background = `var(--pin${own.colour})`;
    return el('li', {}, swatch, own.label, ' ', el('button', { type: 'button', 'aria-label': `remove ${own.label}`, text: '×', onclick: () => { chart.pins.splice(index, 1); showPins(); } }));
  }));
  draw();
}

export async function link() {
  const address = `${location.origin}/${toHash(session.models)}`;
  history.replaceState(null, '', toHash(session.models));
  let where = 'The address of this page is the link.';
  try {
    await navigator.clipboard.writeText(address);
    where = 'The link is in the clipboard; the address of this page is the same.';
  } catch { /* Without leave to write there, the address is what there is. */ }
  byId('export-said').textContent = where;
}

export async function exported(form) {
  byId('export-said').textContent = 'writing';
  byId('export-said').classList.remove('fault');
  try {
    const { export: file } = await ask('export', { export: { ...request(), scale: state.yscale, form } }, progress);
    status('');
    const address = URL.createObjectURL(new Blob([file.contents]));
    const anchor = el('a', { href: address, download: file.name });
    anchor.click();
    setTimeout(() => URL.revokeObjectURL(address), 10_000);
    byId('export-said').textContent = `${file.name}, ${new Blob([file.contents]).size} bytes`;
    byId('lines').hidden = form !== 'rust';
    if (form === 'rust') byId('lines').value = file.contents;
  } catch (error) {
    byId('export-said').textContent = '';
    if (error instanceof Refused) {
      byId('export-said').textContent = error.message;
      byId('export-said').classList.add('fault');
    } else report(error);
  }
}
