// Measured values over the curve, and parameters fitted to them. The table stays in the page.

import { chart, draw } from './chart.js';
import * as controls from './controls.js';
import { changed, settled } from './curves.js';
import { byId, el } from './dom.js';
import { ask, Refused } from './net.js';
import { names, progress, report, request, session, status } from './session.js';
import { state } from './state.js';

let table = '';

// With the values of all parameters, whatever varies along the axis.
const of = () => ({ ...request().of, varied: 'omega' });

function fail(error) {
  if (!(error instanceof Refused)) return report(error);
  byId('fit-fault').textContent = error.message;
  byId('fit-fault').hidden = false;
  return undefined;
}

// Takes a table, and shows its values over the curve of what was measured.
async function take(text) {
  byId('fit-fault').hidden = true;
  byId('fitted').hidden = true;
  try {
    const { table: sets } = await ask('table', { table: { of: of(), table: text } });
    table = text;
    chart.measured = sets;
    byId('sets').textContent = sets.map((set) => `${set.name}: ${set.values.length} values`).join('; ');
    byId('fitting').hidden = false;
    offer();
    see(sets);
  } catch (error) {
    fail(error);
  }
}

// The first set is in sight: drawn is what was measured, and the range holds all of its values.
function see(sets) {
  const places = sets.filter((set) => set.varied === sets[0].varied).flatMap((set) => set.places);
  const ends = [Math.min(...places), Math.max(...places)];
  if (sets[0].varied !== state.varied) Object.assign(state, { varied: sets[0].varied, from: ends[0], to: ends[1], at: null });
  const [low, high] = [Math.min(state.from, state.to), Math.max(state.from, state.to)];
  if (ends[0] < low || ends[1] > high) Object.assign(state, { from: Math.min(low, ends[0]), to: Math.max(high, ends[1]) });
  changed('plot', sets[0].plot);
  session.filled();
  draw();
}

// Which parameters are free; of another model others can be.
export function offer() {
  if (chart.measured.length === 0) return;
  const varied = chart.measured.map((set) => set.varied);
  const chosen = [...byId('free').querySelectorAll('input:checked')].map((box) => box.value);
  byId('free').replaceChildren(...names().filter((name) => !varied.includes(name)).map((name) => el('label', {}, el('input', { type: 'checkbox', value: name, checked: chosen.includes(name) }), ` ${name} `)));
}

async function fit() {
  const free = [...byId('free').querySelectorAll('input:checked')].map((box) => box.value);
  byId('fit-fault').hidden = true;
  status('fitting');
  const begun = JSON.stringify(of());
  try {
    const { fit: fitted } = await ask('fit', { fit: { of: of(), table, free } }, progress);
    status('');
    if (begun !== JSON.stringify(of())) {
      byId('fit-fault').textContent = 'The model or its values have changed while they were fitted: fit again.';
      byId('fit-fault').hidden = false;
      return;
    }
    for (const [name, value] of fitted.values) state.values[name] = value;
    byId('fitted').textContent = fitted.said + (fitted.converged ? '' : '\nIt did not converge: these are the best values until then.');
    byId('fitted').hidden = false;
    controls.refresh();
    settled();
  } catch (error) {
    status('');
    fail(error);
  }
}

function forget() {
  [table, chart.measured] = ['', []];
  for (const id of ['fitting', 'fitted', 'fit-fault']) byId(id).hidden = true;
  byId('data').value = '';
  draw();
}

async function read(file) {
  if (file) take(await file.text());
}

export function listen() {
  byId('data').addEventListener('change', () => read(byId('data').files[0]));
  byId('fit').addEventListener('click', fit);
  byId('no-data').addEventListener('click', forget);
  // Words that are dragged within the text go where they always do.
  const has = (event) => event.dataTransfer?.types.includes('Files');
  addEventListener('dragover', (event) => has(event) && event.preventDefault());
  addEventListener('drop', (event) => {
    if (!has(event)) return;
    event.preventDefault();
    read(event.dataTransfer.files[0]);
  });
}
