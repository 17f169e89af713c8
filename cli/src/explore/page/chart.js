// The curve, its shadow and the pinned ones.

import { extent, frame, line } from './axes.js';
import { byId, el, inUnit, short, svg } from './dom.js';
import { state } from './state.js';

// Marks that are nearer, in pixels, would lie upon each other.
const NEAR = 14;
// Numbers of motions are as far from each other, at least.
const APART = 17;
// Places on either side that are tried for them.
const ASIDE = 12;

const KINDS = {
  fold: 'the curve turns back, and on the side that it leaves free what moves jumps to another branch',
  'period-doubling': 'motions begin here that repeat after twice the period of this curve',
  'symmetry-breaking': 'the motion loses its symmetry',
  'branch-point': 'two curves of motions cross',
  'neimark-sacker': 'a second frequency begins',
  grazing: 'a contact just opens, or is just touched',
};

export const meaning = (kind) => KINDS[kind] ?? '';

// A mark of its own for each kind.
export function mark(kind, x, y, size = 5) {
  const shapes = {
    fold: `M${-size} 0a${size} ${size} 0 1 0 ${2 * size} 0a${size} ${size} 0 1 0 ${-2 * size} 0Z`,
    'period-doubling': `M${-size} ${-size}H${size}V${size}H${-size}Z`,
    'symmetry-breaking': `M0 ${-1.3 * size}L${1.3 * size} 0L0 ${1.3 * size}L${-1.3 * size} 0Z`,
    'branch-point': `M0 ${-1.2 * size}L${1.2 * size} ${size}H${-1.2 * size}Z`,
    'neimark-sacker': `M${-size} ${-size}L${size} ${size}M${size} ${-size}L${-size} ${size}M0 ${-1.3 * size}V${1.3 * size}`,
    grazing: `M${-1.2 * size} 0H${1.2 * size}M0 ${-1.2 * size}V${1.2 * size}`,
  };
  return svg('path', { class: 'mark', d: shapes[kind] ?? shapes.fold, transform: `translate(${x.toFixed(1)} ${y.toFixed(1)})` });
}

// Events whose marks would lie upon each other are one mark with their number.
function together(events, px, py) {
  const groups = [];
  for (const [number, event] of events.entries()) {
    const [x, y] = [px(event.value), event.size === null ? NaN : py(event.size)];
    if (!Number.isFinite(x) || !Number.isFinite(y)) continue;
    const near = groups.find((group) => Math.hypot(group.x - x, group.y - y) < NEAR);
    if (near) near.events.push(event);
    else groups.push({ x, y, number, events: [event] });
  }
  return groups;
}

export const chart = {
  curve: null,
  shadow: null,
  pins: [],
  solutions: [],
  measured: [], // sets of values
  domain: null, // of the axes while a slider is dragged
  place: null, // the frame that was drawn last
};

const svgOf = () => byId('chart');

function flats(curve) {
  return curve.branches.flatMap((branch) => branch.runs.map((run) => run.places));
}

function comparable(curve) {
  return curve && chart.curve && curve.varied === chart.curve.varied && curve.plot === chart.curve.plot;
}

// The range of the vertical axis: what is drawn fits, and while it moves the axis only grows.
function verticalOf(curves, sets, dragging) {
  const drawn = curves.flatMap((curve) => flats(curve).flatMap((flat) => flat.filter((_, i) => i % 2 === 1)));
  const all = drawn.concat(...sets.map((set) => set.values));
  let [low, high] = extent(all);
  if (state.yscale !== 'linear') {
    [low, high] = extent(all.filter((value) => value > 0));
    if (low < high * 1e-12) low = high * 1e-12;
  }
  if (!Number.isFinite(low)) return [0, 1];
  if (state.yscale === 'linear') {
    const pad = 0.05 * (high - low || Math.abs(high) || 1);
    low = low >= 0 && low < 0.4 * high ? 0 : low - pad;
    high += pad;
  } else {
    low /= 1.2;
    high *= 1.2;
  }
  if (dragging && chart.domain) {
    low = Math.min(low, chart.domain[0]);
    high = Math.max(high, chart.domain[1]);
  }
  chart.domain = [low, high];
  return chart.domain;
}

function horizontal(curve) {
  const ends = [Math.min(state.from, state.to), Math.max(state.from, state.to)];
  // Branches from bifurcations may go beyond.
  const [low, high] = extent(flats(curve).flatMap((flat) => flat.filter((_, i) => i % 2 === 0)));
  const domain = [Math.min(ends[0], Number.isFinite(low) ? low : ends[0]), Math.max(ends[1], Number.isFinite(high) ? high : ends[1])];
  if (state.xscale === 'log' && !(domain[0] > 0)) domain[0] = domain[1] > 0 ? domain[1] / 1e3 : 1e-3;
  return domain;
}

// A model that declares no unit at all is one of numbers.
const bare = (curve, unit) => (unit || curve.unit ? '' : ', dimensionless as declared');

// Names of branches, where there are several, as what is said of them has it: each in the middle of its branch, as far as that is seen.
function namesOf(branches, { px, py, box }) {
  const names = svg('g', { id: 'names' });
  if (branches.length < 2) return names;
  branches.forEach((branch, number) => {
    const places = branch.runs.flatMap((run) => Array.from({ length: run.places.length / 2 }, (_, i) => [run.places[2 * i], run.places[2 * i + 1]]));
    const known = places.filter((place) => !place.includes(null)).map(([value, size]) => [px(value), py(size)]);
    const seen = known.filter(([x, y]) => x > box.left && x < box.right && y > box.top && y < box.bottom);
    const middle = seen[Math.floor(seen.length / 2)];
    if (middle) names.append(svg('text', { class: 'name', x: middle[0], y: middle[1] - 8, text: `branch ${number + 1}` }));
  });
  return names;
}

// Draws everything anew.
export function draw({ dragging = false } = {}) {
  const target = svgOf();
  const { width, height } = target.getBoundingClientRect();
  const curve = chart.curve;
  if (!curve || width < 50) return;
  target.setAttribute('viewBox', `0 0 ${width} ${height}`);
  const others = [chart.shadow, ...chart.pins.map((pin) => pin.curve)].filter(comparable);
  const seen = chart.measured.filter((set) => set.plot === curve.plot && set.varied === curve.varied);
  const on = frame(width, height, {
    x: { domain: horizontal(curve), scale: state.xscale, label: inUnit(curve.varied, curve.varied_unit) + bare(curve, curve.varied_unit) },
    y: { domain: verticalOf([curve, ...others], seen, dragging), scale: state.yscale, label: inUnit(curve.label, state.yscale === 'db' ? curve.unit ? `dB re 1 ${curve.unit}` : 'dB re 1' : curve.unit) },
  });
  chart.place = on;
  byId('missing').hidden = state.yscale === 'linear' || !flats(curve).some((flat) => flat.some((v, i) => i % 2 === 1 && v !== null && v <= 0));
  const { px, py, box } = on;
  const clip = svg('clipPath', { id: 'inside' }, svg('rect', { x: box.left, y: box.top, width: box.right - box.left, height: box.bottom - box.top }));
  const shadows = svg('g', { class: 'shadow', 'clip-path': 'url(#inside)' });
  if (comparable(chart.shadow)) for (const flat of flats(chart.shadow)) shadows.append(svg('path', { d: line(flat, px, py) }));
  const pins = svg('g', { 'clip-path': 'url(#inside)' });
  for (const pin of chart.pins.filter((candidate) => comparable(candidate.curve))) {
    for (const branch of pin.curve.branches) {
      for (const run of branch.runs) {
        const path = svg('path', { class: run.verdict, d: line(run.places, px, py) });
        path.style.stroke = `var(--pin${pin.colour})`;
        pins.append(path);
      }
    }
  }
  const curves = svg('g', { id: 'curve', class: curve.effort === 'screen' ? 'coarse' : 'exact', 'clip-path': 'url(#inside)' });
  for (const branch of curve.branches) for (const run of branch.runs) curves.append(svg('path', { class: run.verdict, d: line(run.places, px, py) }));
  const marks = svg('g', { id: 'marks' });
  const groups = together(curve.events, px, py);
  const kinds = [...new Set(curve.events.map((event) => event.kind))];
  byId('kinds').replaceChildren(...kinds.map((kind) => el('span', {}, svg('svg', { viewBox: '-7 -7 14 14' }, mark(kind, 0, 0)), kind.replaceAll('-', ' '))));
  byId('many').hidden = groups.every(({ events }) => events.length === 1);
  for (const { x, y, number, events } of groups) {
    const shape = events.length === 1 ? mark(events[0].kind, x, y) : svg('rect', { class: 'mark', x: x - 13, y: y - 8, width: 26, height: 16, rx: 3 });
    shape.dataset.event = number;
    shape.append(svg('title', { text: events.map((event) => `${event.said}: ${meaning(event.kind)}`).join('\n') }));
    marks.append(shape);
    if (events.length > 1) marks.append(svg('text', { class: 'count', x, y: y + 4, text: `× ${events.length}` }));
  }
  const here = svg('g', { id: 'here' });
  if (state.at !== null) {
    const x = px(state.at);
    if (x >= box.left && x <= box.right) here.append(svg('line', { class: 'here', x1: x, x2: x, y1: box.top, y2: box.bottom }));
    // The chosen one has its place first.
    const shown = chart.solutions.map((own, index) => ({ ...own, number: index + 1 })).sort((a, b) => b.chosen - a.chosen);
    const placed = [];
    for (const { size, chosen, number } of shown) {
      const y = size === null ? NaN : py(size);
      if (!Number.isFinite(y)) continue;
      // Beside the line where others are in the way, with a line to its place.
      const free = (u) => u > box.left && u < box.right && placed.every(([other, v]) => Math.hypot(other - u, v - y) >= APART - 1);
      const places = Array.from({ length: 2 * ASIDE + 1 }, (_, k) => x + (k % 2 === 0 ? -1 : 1) * Math.ceil(k / 2) * APART);
      const aside = places.find(free) ?? x;
      placed.push([aside, y]);
      if (aside !== x) here.append(svg('line', { class: 'lead', x1: x, x2: aside, y1: y, y2: y }));
      here.append(svg('circle', { class: chosen ? 'solution chosen' : 'solution', cx: aside, cy: y, r: 8 }));
      here.append(svg('text', { class: 'number', x: aside, y: y + 4, text: number }));
    }
  }
  const values = svg('g', { id: 'values', 'clip-path': 'url(#inside)' });
  for (const { places, values: sizes } of seen) places.forEach((place, i) => {
    if (Number.isFinite(py(sizes[i]))) values.append(svg('circle', { class: 'measured', cx: px(place), cy: py(sizes[i]), r: 3 }));
  });
  target.replaceChildren(clip, ...on.parts, shadows, pins, curves, namesOf(curve.branches, on), values, marks, here, svg('circle', { id: 'hover', class: 'hover', r: 3, cx: -9, cy: -9 }));
  target.setAttribute('aria-label', `${curve.label} over ${curve.varied}: ${curve.events.length} events, ${curve.events.map((event) => event.said).join('; ')}`);
}

// The place of the curve that is nearest to one on the screen: value, size, how far, and what is known of it.
export function nearest(clientX, clientY) {
  if (!chart.curve || !chart.place) return null;
  const bounds = svgOf().getBoundingClientRect();
  const [x, y] = [clientX - bounds.left, clientY - bounds.top];
  const { px, py, value } = chart.place;
  let best = { far: Infinity };
  chart.curve.branches.forEach((branch, number) => {
    for (const run of branch.runs) {
      for (let i = 0; i + 1 < run.places.length; i += 2) {
        const [v, size] = [run.places[i], run.places[i + 1]];
        if (v === null || size === null) continue;
        const far = Math.hypot(px(v) - x, py(size) - y);
        if (far < best.far) best = { far, value: v, size, verdict: run.verdict, branch: number, period: branch.period };
      }
    }
  });
  return { ...best, under: value(x), clicked: y };
}

// What is said of a place on the curve: of an orbit that was computed with more digits than of a place between two.
export function said(drawn) {
  const orbits = chart.curve.branches[drawn.branch]?.orbits ?? [];
  const orbit = orbits.find(([value, size]) => Math.fround(value) === drawn.value && Math.fround(size) === drawn.size);
  const place = orbit ? { ...drawn, value: orbit[0], size: orbit[1] } : drawn;
  const digits = orbit ? 9 : 5;
  const { varied, varied_unit: unit, label, unit: measured } = chart.curve;
  const period = place.period > 1 ? `, period ${place.period}` : '';
  return `${varied} ${short(place.value, digits + 1)} ${unit}: ${label} ${short(place.size, digits)} ${measured}, ${place.verdict}${period}`.replace(/ +/g, ' ').replace(' :', ':').replace(' ,', ',');
}
