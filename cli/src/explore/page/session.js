// What all of the page knows: the models, the declaration of the moment, and where it is said that something is wrong.

import * as controls from './controls.js';
import { byId } from './dom.js';
import * as editor from './editor.js';
import { Lost, models as fetchModels, Refused, Superseded } from './net.js';
import { asked, state } from './state.js';

// Between two attempts to reach the program, in milliseconds.
const AGAIN = 800;

export const session = {
  models: [],
  declared: null, // what the text that was compiled last declares
  isFine: true, // whether the text that stands there is one
  back: () => {}, // when a program that was gone answers again
  filled: () => {}, // when fields are to show another state
};

export const names = () => (session.declared ? session.declared.parameters.map((parameter) => parameter.name) : []);
export const request = () => ({ of: asked(names()), plot: state.plot });
export const time = () => (session.declared?.has_units ? 'time [s]' : 'time');

export function status(text) {
  byId('status').textContent = text;
}

export const progress = (line) => line.progress && status(line.progress);

// When something was drawn, for whoever measures it; the last few hundred times.
export function note(name) {
  if (performance.getEntriesByName(name).length > 500) performance.clearMarks(name);
  performance.mark(name);
}

// Says what is wrong where it belongs.
export function report(error, place = 'fault') {
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
  if (place === 'fault') byId('chart').classList.add('old');
  if (!controls.fault(fault.field, fault.message)) {
    byId(place).textContent = fault.message;
    byId(place).hidden = false;
  }
  if (place === 'orbit-fault') byId('orbit').hidden = false;
}

let isWaiting = false;

async function lost() {
  if (isWaiting) return;
  isWaiting = true;
  status('');
  byId('lost').textContent = 'The program does not answer: start `hertzian explore` again with the same port, and this page goes on where it is.';
  byId('lost').hidden = false;
  for (;;) {
    await new Promise((done) => { setTimeout(done, AGAIN); });
    try {
      session.models = await fetchModels();
      break;
    } catch { /* It is still gone. */ }
  }
  isWaiting = false;
  byId('lost').hidden = true;
  session.back();
}
