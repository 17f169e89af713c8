// All motions at a value, and which of them is shown.

import { chart, draw } from './chart.js';
import { byId, el } from './dom.js';
import { showCommand } from './found.js';
import { ask } from './net.js';
import * as orbit from './orbit.js';
import { note, progress, report, request, session, status, time } from './session.js';
import { keep, state } from './state.js';

let orbits = null;
let chosen = 0;
let wantedSize = null;

// What is shown is not of the curve that is drawn any more.
export function outdate() {
  chart.solutions = [];
  byId('orbit').classList.add('old');
}

export function forget() {
  [orbits, wantedSize] = [null, null];
  chart.solutions = [];
  byId('orbit').hidden = true;
}

// Which one was clicked is not known in another measure.
export function forgetSize() {
  wantedSize = null;
}

export function redraw() {
  if (orbits && orbits.orbits.length > 0 && !byId('orbit').hidden) orbit.show(orbits.orbits[chosen], time());
}

export async function pick(value, size = null) {
  state.at = value;
  if (size !== null) wantedSize = size;
  keep(session.models);
  draw();
  showCommand();
  const wanted = JSON.stringify(request());
  try {
    const answer = await ask('orbits', { orbits: { ...request(), at: value } }, progress);
    // Meanwhile something else may have changed, and others are asked for.
    if (wanted !== JSON.stringify(request())) return;
    orbits = answer.orbits;
    status('');
    chosen = choice();
    byId('orbit-fault').hidden = true;
    showOrbits();
  } catch (error) {
    report(error, 'orbit-fault');
  }
}

// The one whose size was clicked, or else the first that one would see.
function choice() {
  const all = orbits.orbits;
  if (wantedSize === null) return Math.max(0, all.findIndex((own) => own.verdict === 'stable'));
  const far = all.map((own) => (own.size === null ? Infinity : Math.abs(own.size - wantedSize)));
  return Math.max(0, far.indexOf(Math.min(...far)));
}

function showOrbits() {
  byId('orbit').hidden = false;
  byId('orbit').classList.remove('old');
  const count = orbits.orbits.length;
  byId('orbit-title').textContent = `${count === 0 ? 'No motion' : count === 1 ? '1 motion' : `${count} motions`} at ${state.varied} = ${orbits.said}${count > 1 ? ', in the order along the curve' : ''}`;
  byId('solutions').replaceChildren(...orbits.orbits.map((own, index) => el('button', {
    type: 'button', 'aria-pressed': String(index === chosen), text: `${own.verdict}, ${own.measured}`,
    onclick: () => { chosen = index; wantedSize = own.size; showOrbits(); },
  })));
  chart.solutions = orbits.orbits.map((own, index) => ({ size: own.size, chosen: index === chosen }));
  draw();
  if (count > 0) orbit.show(orbits.orbits[chosen], time());
  else {
    byId('panels').replaceChildren();
    byId('verdict').textContent = '';
  }
  if (orbits.notes.length > 0) byId('verdict').append(el('span', { class: 'small', text: ` ${orbits.notes.join('; ')}` }));
  note('drawn-orbits');
}
