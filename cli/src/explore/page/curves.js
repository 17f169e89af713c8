// Which curve is asked for, how exactly, and when: as exactly as a screen while something moves, and then to all digits.

import { chart, draw } from './chart.js';
import * as controls from './controls.js';
import { byId, short } from './dom.js';
import { showFound, showMeasure } from './found.js';
import { outdate, pick } from './motions.js';
import { ask } from './net.js';
import { note, progress, report, request, session, status } from './session.js';
import { keep, state } from './state.js';

// A request on the screen that takes longer is given up for a newer one, in milliseconds.
const PATIENCE = 250;
// After so long without a move the exact curve is asked for, before the slider is let go.
const PAUSE = 140;

let dragging = false;
let turn = 0;
let busySince = null;
let again = false;
let pause = null;
let exact = ''; // the request of the exact curve that was asked for last

function accept(curve, values) {
  chart.curve = { ...curve, values };
  byId('fault').hidden = true;
  byId('chart').classList.remove('old');
  if (session.isFine) controls.clearFaults();
  draw({ dragging });
  saidBefore(values);
  showFound(curve, pick);
  showMeasure(curve.plot);
  note(`drawn-${curve.effort}`);
}

// Of what the curve behind is.
function saidBefore(values) {
  const old = chart.shadow;
  byId('before-key').hidden = !old || old.varied !== chart.curve.varied || old.plot !== chart.curve.plot;
  const others = Object.keys(values).filter((name) => Number.isFinite(old?.values?.[name]) && old.values[name] !== values[name]);
  byId('before').textContent = others.length > 0 ? others.map((name) => `${name} = ${short(old.values[name], 4)}`).join(', ') : 'the last change';
}

async function onScreen() {
  const now = performance.now();
  if (busySince !== null && now - busySince < PATIENCE) {
    again = true;
    return;
  }
  turn += 1;
  const mine = turn;
  [busySince, again] = [now, false];
  exact = '';
  const values = { ...state.values };
  try {
    const answer = await ask('curve', { curve: { ...request(), effort: 'screen' } }, progress);
    if (mine === turn) accept(answer.curve, values);
  } catch (error) {
    if (mine === turn) report(error);
  }
  if (mine !== turn) return;
  busySince = null;
  if (again && dragging) onScreen();
}

export async function exactly() {
  const wanted = JSON.stringify(request());
  if (wanted === exact) return;
  exact = wanted;
  turn += 1;
  const mine = turn;
  busySince = null;
  status('computing');
  keep(session.models);
  const values = { ...state.values };
  try {
    await ask('curve', { curve: { ...request(), effort: 'full' } }, (line) => {
      if (mine !== turn) return;
      progress(line);
      if (line.curve) {
        accept(line.curve, values);
        status(line.curve.lacks ? 'looking for what else is in the range' : '');
      }
    });
    if (mine === turn && state.at !== null) pick(state.at);
  } catch (error) {
    if (mine !== turn) return;
    exact = '';
    status('');
    report(error);
  }
}

export function moved() {
  if (!dragging) {
    dragging = true;
    shadow();
  }
  outdate();
  controls.refresh();
  onScreen();
  clearTimeout(pause);
  pause = setTimeout(exactly, PAUSE);
}

export function settled() {
  note('released');
  clearTimeout(pause);
  const isNew = JSON.stringify(request()) !== exact;
  if (isNew && !dragging) shadow();
  if (isNew) outdate();
  dragging = false;
  controls.refresh();
  if (isNew) exactly();
  else draw();
}

// What was drawn is shown behind what will be.
export function shadow() {
  if (chart.curve?.effort === 'full') chart.shadow = chart.curve;
}

// Something but a slider has changed.
export function changed(name, value) {
  state[name] = value;
  shadow();
  outdate();
  dragging = false;
  exactly();
}

// Nothing that was asked for counts any more.
export function renew() {
  [exact, busySince, dragging] = ['', null, false];
}
