// Sliders and fields of the parameters, from the declaration.

import { byId, el, short, written } from './dom.js';
import { state } from './state.js';

const STEPS = 1000;

// The range of a slider: what the declaration says, or about the default.
export function usual(parameter) {
  const known = parameter.default ?? 1;
  let low = parameter.minimum?.value ?? (known > 0 ? 0 : known < 0 ? 4 * known : -1);
  let high = parameter.maximum?.value ?? (known > low ? low + 4 * (known - low) : Math.max(low + 1, -4 * low));
  if (!(high > low)) high = low + 1;
  // Over decades where the range spans them.
  const log = low > 0 && high / low >= 100;
  if (!log && parameter.minimum && !parameter.minimum.included) low += (high - low) / STEPS;
  if (!log && parameter.maximum && !parameter.maximum.included) high -= (high - low) / STEPS;
  return [low, high, log];
}

function rangeOf(parameter) {
  const kept = state.ranges[parameter.name];
  const fits = Array.isArray(kept) && Number.isFinite(kept[0]) && kept[1] > kept[0];
  const [low, high, log] = fits ? kept : usual(parameter);
  return log && !(low > 0) ? [high > 0 ? high / 1e4 : 1e-4, Math.max(high, 1), true] : [low, high, Boolean(log)];
}

const toPlace = ([low, high, log], value) => Math.round(STEPS * (log ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low)));

// Rounded to what a step of the slider is worth, so that a value is not longer than it must be.
function toValue([low, high, log], place) {
  const part = place / STEPS;
  if (log) return Number((low * (high / low) ** part).toPrecision(4));
  const step = (high - low) / STEPS;
  const decimals = Math.max(0, Math.min(20, Math.ceil(-Math.log10(step))));
  return Number((low + part * (high - low)).toFixed(decimals));
}

// A row for each parameter. `moved` is called while a slider is dragged, `settled` when a value is chosen.
export function build(parameters, { moved, settled }) {
  const rows = parameters.map((parameter) => {
    const { name } = parameter;
    let range = rangeOf(parameter);
    const id = `parameter-${name}`;
    const value = el('input', { class: 'value', id, inputmode: 'decimal', 'aria-label': `value of ${name}` });
    const slider = el('input', { type: 'range', min: 0, max: STEPS, step: 1, 'data-slider': name, 'aria-label': `${name}: ${parameter.documentation}` });
    const low = el('input', { inputmode: 'decimal', 'aria-label': `least ${name} of the slider` });
    const high = el('input', { inputmode: 'decimal', 'aria-label': `largest ${name} of the slider` });
    const log = el('input', { type: 'checkbox' });
    const ends = [el('span'), el('span')];
    const showEnds = () => ends.forEach((end, side) => { end.textContent = short(range[side], 3); });
    const show = () => {
      const own = state.values[name];
      // A value that was given otherwise may lie beyond.
      const reached = [Math.min(range[0], own), Math.max(range[1], own)];
      if ((reached[0] < range[0] || reached[1] > range[1]) && (!range[2] || reached[0] > 0)) {
        range = [...reached, range[2]];
        showEnds();
      }
      slider.value = Number.isFinite(own) ? toPlace(range, own) : 0;
      slider.setAttribute('aria-valuetext', `${own} ${parameter.unit}`.trim());
      if (document.activeElement !== value) value.value = Number.isFinite(own) ? String(own) : '';
    };
    const showRange = () => {
      [low.value, high.value] = [short(range[0], 6), short(range[1], 6)];
      showEnds();
      log.checked = range[2];
      show();
    };
    slider.addEventListener('input', () => {
      state.values[name] = toValue(range, Number(slider.value));
      value.value = String(state.values[name]);
      moved(name);
    });
    slider.addEventListener('change', () => settled(name));
    value.addEventListener('change', () => {
      const own = written(value.value);
      value.classList.toggle('bad', !Number.isFinite(own));
      if (!Number.isFinite(own)) return fault(name, `\`${value.value}\` is not a number`);
      state.values[name] = own;
      show();
      settled(name);
      return undefined;
    });
    const widen = () => {
      const ends = [written(low.value), written(high.value), log.checked];
      if (ends[2] && !(ends[0] > 0)) ends[0] = ends[1] / 1e4;
      if (ends[1] > ends[0]) {
        state.ranges[name] = ends;
        range = rangeOf(parameter);
      }
      showRange();
    };
    for (const field of [low, high, log]) field.addEventListener('change', widen);
    showRange();
    const admitted = [parameter.minimum && `${parameter.minimum.included ? '≥' : '>'} ${parameter.minimum.value}`, parameter.maximum && `${parameter.maximum.included ? '≤' : '<'} ${parameter.maximum.value}`].filter(Boolean).join(', ');
    const defaulted = parameter.default === null ? 'no default' : `default ${parameter.default}`;
    const row = el('div', { class: 'parameter', 'data-field': name },
      el('div', { class: 'top' }, el('label', { class: 'name', for: id, text: name }), value, el('span', { class: 'unit', text: parameter.unit })),
      el('p', { class: 'about', text: parameter.documentation }),
      slider,
      el('p', { class: 'ends', 'aria-hidden': 'true' }, ...ends),
      el('details', {}, el('summary', { text: [defaulted, admitted].filter(Boolean).join('; ') }),
        el('label', {}, 'slider from ', low), el('label', {}, ' to ', high), el('label', {}, ' ', log, ' over decades')));
    row.show = show;
    return row;
  });
  byId('parameters').replaceChildren(...rows);
}

export function refresh() {
  for (const row of byId('parameters').children) {
    row.classList.toggle('varies', row.dataset.field === state.varied);
    row.show();
  }
}

// A sentence at the field that it is about; gives back whether there is one.
export function fault(field, message) {
  const place = field && [...document.querySelectorAll('[data-field]')].find((candidate) => candidate.dataset.field === field);
  if (!place) return false;
  place.append(el('p', { class: 'fault here-fault', role: 'alert', text: message }));
  place.querySelector('input, select')?.classList.add('bad');
  return true;
}

export function clearFaults() {
  for (const said of document.querySelectorAll('.here-fault')) said.remove();
  for (const field of document.querySelectorAll('.bad')) field.classList.remove('bad');
}
