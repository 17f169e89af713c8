// The page: what is touched, and what follows from it.

import { chart, draw, nearest, said } from './chart.js';
import * as controls from './controls.js';
import { changed, exactly, moved, renew, settled, shadow } from './curves.js';
import { byId, el, written } from './dom.js';
import * as editor from './editor.js';
import { fillMeasures, showCommand } from './found.js';
import { forget, forgetSize, outdate, pick, redraw } from './motions.js';
import * as measured from './measured.js';
import { ask, models as fetchModels, Refused } from './net.js';
import { names, report, session } from './session.js';
import { fromHash, keep, state } from './state.js';
import { exported, link, pin, showPins } from './take.js';

// ---- the declaration

// Asks what a text declares; then its curve.
async function declare(text) {
  state.text = text;
  try {
    const answer = await ask('declaration', { declaration: { text } });
    session.declared = answer.declaration;
  } catch (error) {
    if (error instanceof Refused) session.isFine = error.fault.kind !== 'declaration';
    report(error);
    return;
  }
  session.isFine = true;
  editor.show([]);
  for (const { name, default: own } of session.declared.parameters) {
    if (Number.isFinite(state.values[name])) continue;
    if (own === null) delete state.values[name];
    else state.values[name] = own;
  }
  if (!['omega', ...names()].includes(state.varied)) state.varied = 'omega';
  const signal = state.plot.slice(0, state.plot.lastIndexOf(':'));
  if (!session.declared.signals.some((own) => own.name === signal)) state.plot = '';
  fill();
  renew();
  shadow();
  outdate();
  exactly();
}

function fill() {
  const { equation, parameters, signals } = session.declared;
  byId('equation').textContent = equation;
  controls.build(parameters, { moved, settled });
  controls.refresh();
  byId('varied').replaceChildren(...['omega', ...names()].map((name) => el('option', { value: name, text: name })));
  const about = { coordinate: () => '', contact: () => ', force of a contact', output: (own) => `, ${own.documentation || 'output'}` };
  byId('signal').replaceChildren(...signals.map((own) => el('option', { value: own.name, text: own.name + about[own.kind](own) })));
  measured.offer();
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
  const model = session.models.find((own) => own.name === state.name);
  byId('model').value = model ? state.name : '';
  byId('described').textContent = model?.text === state.text ? model.described : 'edited';
}

// A model to begin with.
function take(model) {
  const [from, to] = model.range;
  Object.assign(state, { name: model.name, text: model.text, values: {}, ranges: {}, varied: 'omega', from, to, omega: (from + to) / 2, period: 1, depth: null, plot: '', at: null });
  for (const [name, value] of model.values) state.values[name] = value;
  chart.curve = null;
  chart.shadow = null;
  forget();
  editor.put(model.text);
}

// ---- what is touched

function listen() {
  byId('model').addEventListener('change', () => {
    const model = session.models.find((own) => own.name === byId('model').value);
    if (!model) return;
    take(model);
    declare(model.text);
  });
  byId('varied').addEventListener('change', () => vary(byId('varied').value));
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
      keep(session.models);
      draw();
      showCommand();
    });
  }
  for (const id of ['signal', 'measure', 'harmonic']) byId(id).addEventListener('change', measure);
  byId('defaults').addEventListener('click', () => {
    for (const { name, default: own } of session.declared?.parameters ?? []) if (own !== null) state.values[name] = own;
    settled();
  });
  byId('pin').addEventListener('click', pin);
  byId('unpin').addEventListener('click', () => {
    chart.pins = [];
    showPins();
  });
  byId('theme').addEventListener('click', () => theme(!document.documentElement.classList.contains('dark')));
  byId('link').addEventListener('click', link);
  for (const button of document.querySelectorAll('[data-form]')) button.addEventListener('click', () => exported(button.dataset.form));
  editor.listen(declare);
  addEventListener('hashchange', () => {
    if (fromHash(location.hash, session.models)) restore();
  });
  onChart();
  const panel = byId('controls');
  const below = () => { byId('below').hidden = panel.scrollTop + panel.clientHeight > panel.scrollHeight - 40; };
  panel.addEventListener('scroll', below);
  panel.addEventListener('toggle', below, true);
  new ResizeObserver(below).observe(panel);
  let timer = null;
  new ResizeObserver(() => {
    draw();
    clearTimeout(timer);
    timer = setTimeout(redraw, 200);
  }).observe(byId('chart'));
}

// Another parameter along the axis, or the frequency, in the range that its slider has.
function vary(name) {
  const model = session.models.find((own) => own.name === state.name);
  const parameter = session.declared?.parameters.find((own) => own.name === name);
  const [from, to] = parameter ? controls.usual(parameter) : model?.range ?? [0.6, 1.6];
  Object.assign(state, { from: Number(from.toPrecision(6)), to: Number(to.toPrecision(6)), at: null });
  forget();
  changed('varied', name);
  chart.shadow = null;
  controls.refresh();
  fields();
}

function measure() {
  fillMeasures(byId('signal').value);
  const own = byId('measure').value;
  const isNumbered = own === 'h' || own === 'phase';
  byId('harmonic-row').hidden = !isNumbered;
  const number = Math.max(1, Math.round(written(byId('harmonic').value)) || 1);
  forgetSize();
  changed('plot', `${byId('signal').value}:${own}${isNumbered ? number : ''}`);
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
    const marked = chart.curve?.events[event.target.closest('[data-event]')?.dataset.event];
    if (marked) {
      pick(marked.value, marked.size);
      return;
    }
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

function theme(dark) {
  document.documentElement.classList.toggle('dark', dark);
}

// ---- the beginning

function restore() {
  editor.put(state.text);
  chart.shadow = null;
  declare(state.text);
}

async function begin() {
  try {
    session.models = await fetchModels();
  } catch (error) {
    report(error);
    return;
  }
  byId('model').replaceChildren(...session.models.map((model) => el('option', { value: model.name, title: model.described, text: model.name })));
  take(session.models[0]);
  if (location.hash.length > 1) fromHash(location.hash, session.models);
  restore();
}

session.filled = () => {
  controls.refresh();
  fields();
};
session.back = () => {
  renew();
  if (session.declared) declare(state.text);
  else begin();
};
theme(matchMedia('(prefers-color-scheme: dark)').matches);
listen();
measured.listen();
begin();
