// The motions at a value: all solutions, and of the chosen one everything that is known.

import { extent, frame, line } from './axes.js';
import { byId, el, inUnit, short, svg } from './dom.js';
import { play } from './play.js';

// Amplitudes that are a smaller part of the largest are not drawn.
const SMALLEST = 1e-4;
const COLOURS = ['--curve', '--pin0', '--pin1', '--pin2', '--pin3', '--pin4', '--accent', '--soft'];

function place(title) {
  return el('figure', { 'data-panel': title }, svg('svg', { role: 'img', 'aria-label': title }), el('figcaption'));
}

// The drawing of a figure that has its place, with its size, and what is said under it.
function panel(title, about) {
  const figure = byId('panels').querySelector(`[data-panel=${title}]`);
  const drawing = figure.querySelector('svg');
  figure.querySelector('figcaption').replaceChildren(...[about].flat());
  const { width, height } = drawing.getBoundingClientRect();
  drawing.setAttribute('viewBox', `0 0 ${width} ${height}`);
  return { drawing, width, height };
}

const padded = ([low, high]) => {
  const pad = 0.06 * (high - low || Math.abs(high) || 1);
  return [low - pad, high + pad];
};
const flat = (xs, ys) => xs.flatMap((x, i) => [x, ys[i]]);

function traces(title, about, x, y, lines, shades = []) {
  const { drawing, width, height } = panel(title, about);
  const on = frame(width, height, {
    bottom: 36,
    x: { label: x, domain: lines.even ? extent(lines.flatMap((l) => l.xs)) : padded(extent(lines.flatMap((l) => l.xs))) },
    y: { label: y, domain: padded(extent(lines.flatMap((l) => l.ys))) },
  });
  const parts = shades.map(([from, to]) => svg('rect', { class: 'shade', x: on.px(from), width: Math.max(0, on.px(to) - on.px(from)), y: on.box.top, height: on.box.bottom - on.box.top }));
  drawing.append(...parts, ...on.parts);
  lines.forEach((own, index) => {
    const path = svg('path', { class: ['trace', 'trace second', 'trace third'][index % 3], d: line(flat(own.xs, own.ys), on.px, on.py) });
    path.style.stroke = `var(${COLOURS[index % COLOURS.length]})`;
    if (own.name) path.append(svg('title', { text: own.name }));
    drawing.append(path);
  });
  return { drawing, on };
}

function even(lines) {
  const own = [...lines];
  own.even = true;
  return own;
}

const DASHES = ['solid', 'dash-dotted', 'dotted'];

// Names in the colours of their lines, where there are several, and how these are drawn.
function several(items) {
  if (items.length < 2) return [];
  return items.flatMap((item, index) => {
    const name = el('b', { text: item.name });
    name.style.color = `var(${COLOURS[index % COLOURS.length]})`;
    return [index === 0 ? ': ' : ', ', name, ` (${DASHES[index % 3]})`];
  });
}

function history(orbit, time) {
  const lines = even(orbit.motions.map((motion) => ({ xs: motion.times, ys: motion.positions, name: motion.name })));
  const shades = orbit.contacts.flatMap((contact) => contact.closed);
  const about = ['Over its period', ...several(orbit.motions), shades.length > 0 ? '; shaded while in contact' : ''];
  const names = orbit.motions.length === 1 ? inUnit(orbit.motions[0].name, orbit.motions[0].unit) : 'position';
  const { drawing, on } = traces('history', about, time, names, lines, shades);
  const now = svg('line', { class: 'here', y1: on.box.top, y2: on.box.bottom, x1: on.box.left, x2: on.box.left });
  drawing.append(now);
  return (t) => {
    now.setAttribute('x1', on.px(t));
    now.setAttribute('x2', on.px(t));
  };
}

function phases(orbit) {
  const lines = orbit.motions.map((motion) => ({ xs: motion.positions, ys: motion.velocities, name: motion.name }));
  const name = orbit.motions.length === 1 ? orbit.motions[0].name : 'position';
  traces('phase', ['Velocity over position', ...several(orbit.motions)], name, 'velocity', lines);
}

function forces(orbit) {
  const lines = orbit.contacts.map((contact) => ({ xs: contact.gaps, ys: contact.forces, name: contact.name }));
  const unit = orbit.contacts[0].unit;
  traces('force', ['Force over penetration, the gap of the declaration', ...several(orbit.contacts), '; left of zero the contact is open'], 'penetration (negative: open)', inUnit(`force of ${orbit.contacts.length === 1 ? orbit.contacts[0].name : 'contacts'}`, unit), lines);
}

function spectrum(orbit) {
  const lines = orbit.spectrum.slice(1);
  const largest = Math.max(...lines.map(([, amplitude]) => amplitude));
  const drawn = lines.map(([omega, amplitude]) => [omega / orbit.omega, amplitude]).filter(([, amplitude]) => amplitude > SMALLEST * largest);
  const { drawing, width, height } = panel('spectrum', `Amplitudes of ${orbit.signal}, in multiples of the excitation frequency; mean ${short(orbit.spectrum[0]?.[1] ?? 0)}`);
  const last = drawn.length > 0 ? drawn[drawn.length - 1][0] : 1;
  const on = frame(width, height, {
    bottom: 36,
    x: { label: 'harmonic', domain: [0, last + 1] },
    y: { label: `amplitude of ${orbit.signal}`, scale: 'log', domain: [SMALLEST * (largest || 1), 2 * (largest || 1)] },
  });
  drawing.append(...on.parts);
  for (const [x, amplitude] of drawn) drawing.append(svg('line', { class: 'stem', x1: on.px(x), x2: on.px(x), y1: on.box.bottom, y2: on.py(amplitude) }));
}

function multipliers(orbit) {
  const { drawing, width, height } = panel('multipliers', 'Floquet multipliers and the unit circle: stable while all are inside');
  const size = Math.max(1.15, ...orbit.multipliers.map(([re, im]) => 1.1 * Math.hypot(re, im)));
  const wide = (size * (width - 70)) / Math.max(1, height - 46);
  const on = frame(width, height, { bottom: 36, x: { label: 'real part', domain: [-wide, wide] }, y: { label: 'imaginary part', domain: [-size, size] } });
  drawing.append(...on.parts);
  drawing.append(svg('ellipse', { class: 'circle', cx: on.px(0), cy: on.py(0), rx: on.px(1) - on.px(0), ry: on.py(0) - on.py(1) }));
  for (const [re, im] of orbit.multipliers) drawing.append(svg('circle', { class: 'multiplier', cx: on.px(re), cy: on.py(im), r: 4 }, svg('title', { text: `${short(re, 6)} ${im < 0 ? '−' : '+'} ${short(Math.abs(im), 6)} i` })));
}

function verdict(orbit) {
  const error = orbit.multiplier_error === null ? 'their error is not known' : `error ${short(orbit.multiplier_error, 1)}`;
  const largest = Math.max(0, ...orbit.multipliers.map(([re, im]) => Math.hypot(re, im)));
  const size = orbit.error === null ? '' : `; peak-to-peak known to ${short(orbit.error, 1)} of itself`;
  const periods = orbit.periods === 1 ? '' : `; repeats after ${orbit.periods} periods of the excitation`;
  return `${orbit.said}, ${orbit.verdict}: the largest multiplier has the modulus ${short(largest, 6)} (${error})${size}${periods}.${orbit.measured.endsWith(orbit.said.split(' ').pop()) ? '' : ` ${orbit.measured}.`}`;
}

// Everything of one orbit.
export function show(orbit, time) {
  byId('panels').replaceChildren();
  byId('verdict').textContent = verdict(orbit);
  const canvas = el('canvas', { role: 'img', 'aria-label': 'The motion' });
  const button = el('button', { type: 'button', text: 'Pause' });
  const touches = orbit.contacts.length > 0;
  byId('panels').append(el('figure', { 'data-panel': 'play' }, canvas, el('figcaption', {}, button, ` The motion; positive is down${touches ? ', a surface in contact is coloured' : ''}`)));
  // All of them have their places before the first is drawn, so that none changes its size.
  byId('panels').append(...['history', 'phase', ...(touches ? ['force'] : []), 'spectrum', 'multipliers'].map(place));
  const follow = history(orbit, time);
  phases(orbit);
  if (touches) forces(orbit);
  spectrum(orbit);
  multipliers(orbit);
  const player = play(canvas, orbit, follow);
  const say = () => { button.textContent = player.playing() ? 'Pause' : 'Play'; };
  button.addEventListener('click', () => { player.toggle(); say(); });
  say();
}
