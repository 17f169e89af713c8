// What happens when something is changed: which curve is asked for, how exactly, and where its answer is shown.

import { chart, draw, mark, meaning, nearest, said } from './chart.js';
import * as controls from './controls.js';
import { byId, el, short, svg, written } from './dom.js';
import * as editor from './editor.js';
import { ask, Lost, models as fetchModels, Refused, Superseded } from './net.js';
import * as orbit from './orbit.js';
import { asked, fromHash, state, toHash } from './state.js';

// A request on the screen that takes longer is given up for a newer one, in milliseconds.
const PATIENCE = 250;
// After so long without a move the exact curve is asked for, before the slider is let go.
const PAUSE = 140;
// Between two attempts to reach the program.
const AGAIN = 800;

const MEASURES = [
  ['p2p', 'peak-to-peak'], ['h', 'amplitude of a harmonic'], ['mean', 'mean'], ['rms', 'rms'], ['max', 'largest'], ['min', 'smallest'],
  ['phase', 'phase of a harmonic'], ['crest', 'crest factor'],
];
const OF_CONTACTS = [['max', 'peak force'], ['min', 'smallest force'], ['mean', 'mean force'], ['impulse', 'impulse per period'], ['impacts', 'impacts per period']];

let models = [];
let declared = null;
let dragging = false;
let orbits = null;
let chosen = 0;
let wantedSize = null;

const names = () => (declared ? declared.parameters.map((parameter) => parameter.name) : []);
const request = () => ({ of: asked(names()), plot: state.plot });
const time = () => (declared?.has_units ? 'time [s]' : 'time');

function status(text) {
  byId('status').textContent = text;
}

// When something was drawn, for whoever measures it; the last few hundred times.
function note(name) {
  if (performance.getEntriesByName(name).length > 500) performance.clearMarks(name);
  performance.mark(name);
}

// ---- curves

let turn = 0;
let busySince = null;
let again = false;
let pause = null;
let exact = ''; // the request of the exact curve that was asked for last
let exactDone = false;

function accept(curve) {
  if (curve.effort === 'screen' && exactDone && exact === JSON.stringify(request())) return;
  chart.curve = curve;
  byId('fault').hidden = true;
  byId('chart').classList.remove('old');
  if (declaredFine) controls.clearFaults();
  draw({ dragging });
  showFound(curve);
  showMeasure(curve.plot);
  note(`drawn-${curve.effort}`);
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
  try {
    const answer = await ask('curve', { curve: { ...request(), effort: 'screen' } }, (line) => line.progress && status(line.progress));
    if (mine === turn) accept(answer.curve);
  } catch (error) {
    if (mine === turn) report(error);
  }
  if (mine !== turn) return;
  busySince = null;
  if (again && dragging) onScreen();
}

async function exactly() {
  const wanted = JSON.stringify(request());
  if (wanted === exact) return;
  [exact, exactDone] = [wanted, false];
  turn += 1;
  const mine = turn;
  busySince = null;
  status('computing');
  keepState();
  try {
    await ask('curve', { curve: { ...request(), effort: 'full' } }, (line) => {
      if (mine !== turn) return;
      if (line.progress) status(line.progress);
      if (line.curve) {
        exactDone = true;
        accept(line.curve);
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

function moved() {
  if (!dragging) {
    dragging = true;
    if (chart.curve?.effort === 'full') chart.shadow = chart.curve;
    byId('orbit').classList.add('old');
  }
  controls.refresh();
  onScreen();
  clearTimeout(pause);
  pause = setTimeout(exactly, PAUSE);
}

function settled() {
  note('released');
  clearTimeout(pause);
  if (!dragging && chart.curve?.effort === 'full') chart.shadow = chart.curve;
  dragging = false;
  controls.refresh();
  if (JSON.stringify(request()) === exact) draw();
  else exactly();
}

// ---- what is found

function showFound(curve) {
  byId('events').replaceChildren(...curve.events.map((event) => el('li', {}, el('button', {
    type: 'button', 'data-kind': event.kind, title: meaning(event.kind), onclick: () => pick(event.value, event.size),
  }, svg('svg', { viewBox: '-7 -7 14 14', 'aria-hidden': 'true' }, mark(event.kind, 0, 0)), event.said, ' ', el('span', { class: 'about', text: meaning(event.kind) && `— ${meaning(event.kind)}` })))));
  if (curve.events.length === 0) byId('events').append(el('li', { class: 'small', text: 'none in this range' }));
  byId('notes').replaceChildren(...curve.notes.map((text) => el('li', { text })));
  const many = curve.branches.length > 1 ? ` on ${curve.branches.length} branches` : '';
  byId('cost').textContent = `${curve.points} orbits${many} by ${curve.method} in ${short(curve.milliseconds, 2)} ms${curve.effort === 'screen' ? ', as exact as the screen' : ''}`;
  byId('command').value = curve.command;
}

function showMeasure(plot) {
  const cut = plot.lastIndexOf(':');
  const [signal, measure] = [plot.slice(0, cut), plot.slice(cut + 1)];
  const numbered = /^(h|phase)(\d+)$/.exec(measure);
  byId('signal').value = signal;
  fillMeasures(signal);
  byId('measure').value = numbered ? numbered[1] : measure;
  if (numbered) byId('harmonic').value = numbered[2];
  byId('harmonic-row').hidden = !numbered;
}

function fillMeasures(signal) {
  const kind = declared?.signals.find((own) => own.name === signal)?.kind;
  const list = kind === 'contact' ? OF_CONTACTS : MEASURES;
  if (byId('measure').dataset.kind === (kind ?? '')) return;
  byId('measure').dataset.kind = kind ?? '';
  byId('measure').replaceChildren(...list.map(([value, text]) => el('option', { value, text })));
}

// ---- motions

async function pick(value, size = null) {
  state.at = value;
  if (size !== null) wantedSize = size;
  keepState();
  draw({ dragging });
  try {
    const answer = await ask('orbits', { orbits: { ...request(), at: value } }, (line) => line.progress && status(line.progress));
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
  byId('orbit-title').textContent = `Motions at ${chart.curve.varied} = ${orbits.said}: ${count === 0 ? 'none' : count}`;
  byId('solutions').replaceChildren(...orbits.orbits.map((own, index) => el('button', {
    type: 'button', 'aria-pressed': String(index === chosen), text: `${own.verdict}, ${own.measured}`,
    onclick: () => { chosen = index; wantedSize = own.size; showOrbits(); },
  })));
  chart.solutions = orbits.orbits.map((own, index) => ({ size: own.size, chosen: index === chosen }));
  draw({ dragging });
  if (count > 0) orbit.show(orbits.orbits[chosen], time());
  else {
    byId('panels').replaceChildren();
    byId('verdict').textContent = '';
  }
  if (orbits.notes.length > 0) byId('verdict').append(el('span', { class: 'small', text: ` ${orbits.notes.join('; ')}` }));
  note('drawn-orbits');
}

// ---- faults

function report(error, place = 'fault') {
  if (error instanceof Superseded) return;
  if (error instanceof Lost) {
    lost();
    return;
  }
  if (!(error instanceof Refused)) throw error;
  const { fault } = error;
  controls.clearFaults();
  if (fault.kind === 'declaration') {
    editor.show(fault.places);
    return;
  }
  byId('chart').classList.toggle('old', place === 'fault');
  if (!controls.fault(fault.field, fault.message)) {
    byId(place).textContent = fault.message;
    byId(place).hidden = false;
  }
  if (place === 'orbit-fault') byId('orbit').hidden = false;
}

let waiting = null;

function lost() {
  if (waiting !== null) return;
  status('');
  byId('lost').textContent = 'The program does not answer: start `hertzian explore` again with the same port, and this page goes on where it is.';
  byId('lost').hidden = false;
  waiting = setInterval(async () => {
    try {
      models = await fetchModels();
    } catch {
      return;
    }
    clearInterval(waiting);
    waiting = null;
    byId('lost').hidden = true;
    exact = '';
    busySince = null;
    if (declared) declare(state.text);
    else begin();
  }, AGAIN);
}

// ---- the declaration

let declaredFine = true;

async function declare(text, { fresh = false } = {}) {
  state.text = text;
  try {
    const answer = await ask('declaration', { declaration: { text } });
    declared = answer.declaration;
  } catch (error) {
    if (error instanceof Refused) declaredFine = error.fault.kind !== 'declaration';
    report(error);
    return;
  }
  declaredFine = true;
  editor.show([]);
  for (const { name, default: own } of declared.parameters) {
    if (fresh || !Number.isFinite(state.values[name])) {
      if (own === null) delete state.values[name];
      else state.values[name] = own;
    }
  }
  if (!['omega', ...names()].includes(state.varied)) state.varied = 'omega';
  if (!declared.signals.some((own) => own.name === state.plot.slice(0, state.plot.lastIndexOf(':')))) state.plot = '';
  fill();
  exact = '';
  if (chart.curve?.effort === 'full') chart.shadow = chart.curve;
  exactly();
}

function fill() {
  byId('equation').textContent = declared.equation;
  controls.build(declared.parameters, { moved, settled });
  controls.refresh();
  byId('varied').replaceChildren(...['omega', ...names()].map((name) => el('option', { value: name, text: name })));
  byId('signal').replaceChildren(...declared.signals.map((own) => el('option', { value: own.name, text: `${own.name}${own.kind === 'coordinate' ? '' : `, ${own.kind === 'contact' ? 'force of a contact' : own.documentation || 'output'}`}` })));
  fields();
}

function fields() {
  byId('varied').value = state.varied;
  for (const name of ['from', 'to', 'omega', 'period']) byId(name).value = String(state[name]);
  byId('omega-row').hidden = state.varied === 'omega';
  byId('by').value = state.by;
  byId('depth').value = state.depth === null ? '' : String(state.depth);
  byId('xscale').value = state.xscale;
  byId('yscale').value = state.yscale;
  byId('model').value = models.some((model) => model.name === state.name) ? state.name : '';
  byId('described').textContent = models.find((model) => model.name === state.name && model.text === state.text)?.described ?? (state.text ? 'edited' : '');
}

function take(model) {
  Object.assign(state, { name: model.name, text: model.text, values: {}, ranges: {}, varied: 'omega', from: model.range[0], to: model.range[1], omega: (model.range[0] + model.range[1]) / 2, period: 1, depth: null, plot: '', at: null });
  for (const [name, value] of model.values) state.values[name] = value;
  orbits = null;
  chart.shadow = null;
  chart.solutions = [];
  byId('orbit').hidden = true;
  editor.put(model.text);
}

let keeping = null;

function keepState() {
  clearTimeout(keeping);
  keeping = setTimeout(() => history.replaceState(null, '', toHash(models)), 150);
}

// ---- what is touched

function changed(name, value) {
  state[name] = value;
  if (chart.curve?.effort === 'full') chart.shadow = chart.curve;
  dragging = false;
  exactly();
}

function listen() {
  byId('model').addEventListener('change', () => {
    const model = models.find((own) => own.name === byId('model').value);
    if (!model) return;
    take(model);
    declare(model.text, { fresh: false });
  });
  byId('varied').addEventListener('change', () => {
    const name = byId('varied').value;
    const model = models.find((own) => own.name === state.name);
    const parameter = declared.parameters.find((own) => own.name === name);
    const [from, to] = parameter ? controls.usual(parameter) : model?.range ?? [0.6, 1.6];
    Object.assign(state, { from: Number(from.toPrecision(6)), to: Number(to.toPrecision(6)), at: null });
    chart.solutions = [];
    changed('varied', name);
    chart.shadow = null;
    controls.refresh();
    fields();
  });
  for (const name of ['from', 'to', 'omega', 'period']) {
    byId(name).addEventListener('change', () => {
      const value = written(byId(name).value);
      controls.clearFaults();
      if (Number.isFinite(value)) changed(name, value);
      else controls.fault(name, `\`${byId(name).value}\` is not a number`);
    });
  }
  byId('by').addEventListener('change', () => changed('by', byId('by').value));
  byId('depth').addEventListener('change', () => changed('depth', byId('depth').value === '' ? null : Number(byId('depth').value)));
  for (const name of ['xscale', 'yscale']) {
    byId(name).addEventListener('change', () => {
      state[name] = byId(name).value;
      keepState();
      draw();
    });
  }
  const measured = () => {
    fillMeasures(byId('signal').value);
    const measure = byId('measure').value;
    const isNumbered = measure === 'h' || measure === 'phase';
    byId('harmonic-row').hidden = !isNumbered;
    const number = Math.max(1, Math.round(written(byId('harmonic').value)) || 1);
    wantedSize = null;
    changed('plot', `${byId('signal').value}:${measure}${isNumbered ? number : ''}`);
  };
  for (const id of ['signal', 'measure', 'harmonic']) byId(id).addEventListener('change', measured);
  byId('defaults').addEventListener('click', () => {
    for (const { name, default: own } of declared.parameters) if (own !== null) state.values[name] = own;
    settled();
  });
  byId('pin').addEventListener('click', pin);
  byId('unpin').addEventListener('click', () => { chart.pins = []; showPins(); });
  byId('theme').addEventListener('click', () => theme(!document.documentElement.classList.contains('dark')));
  byId('link').addEventListener('click', link);
  for (const button of document.querySelectorAll('[data-form]')) button.addEventListener('click', () => take_away(button.dataset.form));
  editor.listen((text) => declare(text));
  addEventListener('hashchange', () => { if (fromHash(location.hash, models)) restore(); });
  onChart();
  let timer = null;
  new ResizeObserver(() => {
    draw({ dragging });
    clearTimeout(timer);
    timer = setTimeout(() => { if (orbits && orbits.orbits.length > 0 && !byId('orbit').hidden) orbit.show(orbits.orbits[chosen], time()); }, 200);
  }).observe(byId('chart'));
}

function onChart() {
  const target = byId('chart');
  target.addEventListener('pointermove', (event) => {
    const place = nearest(event.clientX, event.clientY);
    const near = place && place.far < 40;
    byId('readout').textContent = near ? said(place) : '';
    const hover = byId('hover');
    if (!hover) return;
    hover.setAttribute('cx', near ? chart.place.px(place.value) : -9);
    hover.setAttribute('cy', near ? chart.place.py(place.size) : -9);
  });
  target.addEventListener('click', (event) => {
    const place = nearest(event.clientX, event.clientY);
    if (!place) return;
    const near = place.far < 40;
    pick(neat(near ? place.value : place.under), near ? place.size : null);
  });
  target.addEventListener('keydown', (event) => {
    const step = { ArrowLeft: -1, ArrowRight: 1, PageDown: -10, PageUp: 10 }[event.key];
    const start = state.at ?? (state.from + state.to) / 2;
    if (event.key === 'Enter' || event.key === ' ') pick(neat(start));
    else if (step) pick(neat(start + (step * Math.abs(state.to - state.from)) / 200));
    else return;
    event.preventDefault();
  });
}

// Rounded to what a pixel is worth.
function neat(value) {
  const step = 10 ** Math.floor(Math.log10(Math.abs(state.to - state.from) / 400));
  const rounded = Number((Math.round(value / step) * step).toPrecision(12));
  return Number.isFinite(rounded) ? rounded : value;
}

function pin() {
  if (!chart.curve) return;
  const used = chart.pins.map((own) => own.colour);
  const colour = [0, 1, 2, 3, 4].find((candidate) => !used.includes(candidate)) ?? chart.pins.length % 5;
  const values = names().filter((name) => name !== state.varied).map((name) => `${name} ${state.values[name]}`);
  chart.pins.push({ curve: chart.curve, colour, label: `${declared.name}: ${values.join(', ')}` });
  showPins();
}

function showPins() {
  byId('unpin').hidden = chart.pins.length === 0;
  byId('pins').replaceChildren(...chart.pins.map((own, index) => {
    const swatch = el('span', { class: 'swatch' });
    swatch.style.background = `var(--pin${own.colour})`;
    return el('li', {}, swatch, own.label, ' ', el('button', { type: 'button', 'aria-label': `remove ${own.label}`, text: '×', onclick: () => { chart.pins.splice(index, 1); showPins(); } }));
  }));
  draw();
}

function theme(dark) {
  document.documentElement.classList.toggle('dark', dark);
}

async function link() {
  const address = `${location.origin}/${toHash(models)}`;
  history.replaceState(null, '', toHash(models));
  let where = 'The address of this page is the link.';
  try {
    await navigator.clipboard.writeText(address);
    where = 'The link is in the clipboard; the address of this page is the same.';
  } catch { /* Without leave to write there, the address is what there is. */ }
  byId('export-said').textContent = where;
}

async function take_away(form) {
  byId('export-said').textContent = 'writing';
  byId('export-said').classList.remove('fault');
  try {
    const { export: file } = await ask('export', { export: { ...request(), scale: state.yscale, form } }, (line) => line.progress && status(line.progress));
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

function restore() {
  if (!['linear', 'log'].includes(state.xscale)) state.xscale = 'linear';
  if (!['linear', 'log', 'db'].includes(state.yscale)) state.yscale = 'linear';
  editor.put(state.text);
  chart.shadow = null;
  declare(state.text);
}

async function begin() {
  try {
    models = await fetchModels();
  } catch (error) {
    report(error);
    return;
  }
  byId('model').replaceChildren(...models.map((model) => el('option', { value: model.name, title: model.described, text: model.name })));
  take(models[0]);
  if (location.hash.length > 1) fromHash(location.hash, models);
  restore();
}

theme(matchMedia('(prefers-color-scheme: dark)').matches);
listen();
begin();
