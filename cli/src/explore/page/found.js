// What is on the curve, in words, and what of it is drawn.

import { chart, mark, meaning } from './chart.js';
import { byId, el, short, svg } from './dom.js';
import { session } from './session.js';
import { state } from './state.js';

const MEASURES = [
  ['p2p', 'peak-to-peak'], ['h', 'amplitude of a harmonic'], ['mean', 'mean'], ['rms', 'rms'], ['max', 'largest'], ['min', 'smallest'],
  ['phase', 'phase of a harmonic'], ['crest', 'crest factor'],
];
const OF_CONTACTS = [['max', 'peak force'], ['min', 'smallest force'], ['mean', 'mean force'], ['impulse', 'impulse per period'], ['impacts', 'impacts per period']];

// Lists the events of a curve and its largest orbit; `pick` is called with the value and the size of what is chosen.
export function showFound(curve, pick) {
  byId('events').replaceChildren(...curve.events.map((event) => el('li', {}, el('button', {
    type: 'button', 'data-kind': event.kind, title: meaning(event.kind), onclick: () => pick(event.value, event.size),
  }, svg('svg', { viewBox: '-7 -7 14 14', 'aria-hidden': 'true' }, mark(event.kind, 0, 0)), event.said, ' ', el('span', { class: 'about', text: meaning(event.kind) && `— ${meaning(event.kind)}` })))));
  if (curve.events.length === 0) byId('events').append(el('li', { class: 'small', text: 'none in this range' }));
  showLargest(curve);
  byId('notes').replaceChildren(...curve.notes.map((text) => el('li', { text })));
  const many = curve.branches.length > 1 ? ` on ${curve.branches.length} branches` : '';
  byId('cost').textContent = `${curve.points} orbits${many} by ${curve.method} in ${short(curve.milliseconds, 2)} ms${curve.effort === 'screen' ? ', as exact as the screen' : ''}`;
  showCommand();
}

// The command that makes the same picture, and says the same of the motions that are shown.
export function showCommand() {
  const scale = state.yscale !== 'linear' || state.depth !== null ? ` --scale ${state.yscale}` : '';
  if (!chart.curve) return;
  // The file that the program was started with has a name.
  const file = session.models.find((model) => model.text === state.text)?.name;
  const quoted = /^[\w./-]+$/.test(file ?? '') ? file : `'${file?.replaceAll("'", "'\\''")}'`;
  const command = file === undefined ? chart.curve.command : chart.curve.command.replace(' --model FILE', () => ` --model ${quoted}`);
  const at = state.at === null ? '' : ` --at ${state.at}`;
  byId('command').value = command + scale + at;
}

// Where the curve is highest, as exactly as it is drawn.
function showLargest(curve) {
  let top = null;
  for (const { places } of curve.branches.flatMap((branch) => branch.runs)) {
    for (let i = 0; i + 1 < places.length; i += 2) {
      if (places[i + 1] !== null && (top === null || places[i + 1] > top[1])) top = [places[i], places[i + 1]];
    }
  }
  const { label, unit, varied, varied_unit: along } = curve;
  const ends = [state.from, state.to].map((end) => Math.abs(end - (top ? top[0] : NaN)));
  const beyond = top && Math.min(...ends) < 1e-6 * Math.abs(state.to - state.from) + 1e-7 * Math.abs(top[0]) ? ', where the range ends' : '';
  byId('largest').textContent = top ? `Highest: ${label} ${short(top[1], 4)} ${unit} at ${varied} ${short(top[0], 4)} ${along}`.replace(/ +/g, ' ').trim() + beyond : '';
}

// Shows what is drawn in the fields.
export function showMeasure(plot) {
  const cut = plot.lastIndexOf(':');
  const [signal, measure] = [plot.slice(0, cut), plot.slice(cut + 1)];
  const numbered = /^(h|phase)(\d+)$/.exec(measure);
  byId('signal').value = signal;
  fillMeasures(signal);
  byId('measure').value = numbered ? numbered[1] : measure;
  if (numbered) byId('harmonic').value = numbered[2];
  byId('harmonic-row').hidden = !numbered;
}

export function fillMeasures(signal) {
  const kind = session.declared?.signals.find((own) => own.name === signal)?.kind;
  const list = kind === 'contact' ? OF_CONTACTS : MEASURES;
  if (byId('measure').dataset.kind === (kind ?? '')) return;
  byId('measure').dataset.kind = kind ?? '';
  byId('measure').replaceChildren(...list.map(([value, text]) => el('option', { value, text })));
}
