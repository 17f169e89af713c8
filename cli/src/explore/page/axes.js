// Scales of axes, and where their ticks are.

import { short, svg } from './dom.js';

// Width of a figure in pixels.
const LETTER = 6.8;

// How a value is spread along an axis: `to` a line on which the axis is even, and back.
export const SCALES = {
  linear: { to: (v) => v, from: (u) => u },
  log: { to: (v) => (v > 0 ? Math.log10(v) : NaN), from: (u) => 10 ** u },
  db: { to: (v) => (v > 0 ? 20 * Math.log10(v) : NaN), from: (u) => 10 ** (u / 20) },
};

// Steps of 1, 2 or 5 times a power of ten, at most so many.
export function evenTicks(low, high, most) {
  const span = high - low;
  if (!(span > 0)) return [low];
  const rough = span / most;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((part) => part * power).find((candidate) => candidate >= rough);
  const ticks = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * span; k += 1) ticks.push(Number((k * step).toPrecision(12)));
  return ticks;
}

function ticksOf(name, low, high, most) {
  if (name !== 'log') return evenTicks(low, high, most).map((u) => ({ u, text: short(u, 6) }));
  if (high - low < 1.2) {
    return evenTicks(10 ** low, 10 ** high, most).filter((v) => v > 0).map((v) => ({ u: Math.log10(v), text: short(v, 4) }));
  }
  const every = Math.max(1, Math.ceil((high - low) / most));
  const ticks = [];
  for (let k = Math.ceil(low); k <= high; k += 1) if (k % every === 0) ticks.push({ u: k, text: k > -4 && k < 5 ? String(10 ** k) : `1e${k}` });
  return ticks;
}

// As many ticks along so many pixels as have numbers beside each other.
function fitting(name, low, high, width) {
  for (let most = Math.floor(width / 40); most > 2; most -= 1) {
    const ticks = ticksOf(name, low, high, most);
    const half = ticks.map(({ text }) => (LETTER * text.length) / 2);
    const apart = ticks.slice(1).map(({ u }, i) => ((u - ticks[i].u) / (high - low)) * width - half[i] - half[i + 1]);
    if (apart.every((own) => own > 10)) return ticks;
  }
  return ticksOf(name, low, high, 2);
}

// A frame with two axes. `domain` is in values; what is returned maps values to places and back.
export function frame(width, height, { x, y, bottom = 40, top = 10, right = 22 }) {
  const scales = { x: SCALES[x.scale ?? 'linear'], y: SCALES[y.scale ?? 'linear'] };
  const ends = { x: x.domain.map(scales.x.to), y: y.domain.map(scales.y.to) };
  for (const axis of [ends.x, ends.y]) {
    if (!(axis[1] > axis[0])) {
      const pad = Math.abs(axis[0]) * 0.1 || 1;
      axis[0] = (Number.isFinite(axis[0]) ? axis[0] : 0) - pad;
      axis[1] = axis[0] + 2 * pad;
    }
  }
  const high = height - top - bottom;
  const upright = ticksOf(y.scale ?? 'linear', ends.y[0], ends.y[1], Math.max(2, high / 28));
  // Room for the longest number beside the name of the axis.
  const left = 30 + LETTER * Math.max(2, ...upright.map(({ text }) => text.length));
  const box = { left, right: width - right, top, bottom: height - bottom };
  const px = (v) => box.left + ((scales.x.to(v) - ends.x[0]) / (ends.x[1] - ends.x[0])) * (box.right - box.left);
  const py = (v) => box.bottom - ((scales.y.to(v) - ends.y[0]) / (ends.y[1] - ends.y[0])) * (box.bottom - box.top);
  const value = (place) => scales.x.from(ends.x[0] + ((place - box.left) / (box.right - box.left)) * (ends.x[1] - ends.x[0]));
  const parts = [];
  for (const { u, text } of fitting(x.scale ?? 'linear', ends.x[0], ends.x[1], box.right - box.left)) {
    const at = box.left + ((u - ends.x[0]) / (ends.x[1] - ends.x[0])) * (box.right - box.left);
    parts.push(svg('line', { class: 'grid', x1: at, x2: at, y1: box.top, y2: box.bottom }));
    parts.push(svg('text', { x: at, y: box.bottom + 15, 'text-anchor': 'middle', text }));
  }
  for (const { u, text } of upright) {
    const at = box.bottom - ((u - ends.y[0]) / (ends.y[1] - ends.y[0])) * (box.bottom - box.top);
    parts.push(svg('line', { class: 'grid', x1: box.left, x2: box.right, y1: at, y2: at }));
    parts.push(svg('text', { x: box.left - 6, y: at + 4, 'text-anchor': 'end', text }));
  }
  parts.push(svg('rect', { class: 'frame', x: box.left, y: box.top, width: Math.max(0, box.right - box.left), height: Math.max(0, box.bottom - box.top) }));
  parts.push(svg('text', { class: 'title', x: (box.left + box.right) / 2, y: height - 6, 'text-anchor': 'middle', text: x.label }));
  const middle = (box.top + box.bottom) / 2;
  parts.push(svg('text', { class: 'title', transform: `translate(13 ${middle}) rotate(-90)`, 'text-anchor': 'middle', text: y.label }));
  return { box, px, py, value, parts };
}

// The line through places that come as x, y, x, y; null breaks it. It is cut off outside of the box by whoever draws it.
export function line(flat, px, py) {
  let path = '';
  let pen = false;
  for (let i = 0; i + 1 < flat.length; i += 2) {
    const x = flat[i] === null ? NaN : px(flat[i]);
    const y = flat[i + 1] === null ? NaN : py(flat[i + 1]);
    if (Number.isFinite(x) && Number.isFinite(y)) {
      path += `${pen ? 'L' : 'M'}${x.toFixed(1)} ${y.toFixed(1)}`;
      pen = true;
    } else pen = false;
  }
  return path;
}

export function extent(values) {
  let low = Infinity;
  let high = -Infinity;
  for (const value of values) {
    if (value !== null && Number.isFinite(value)) {
      low = Math.min(low, value);
      high = Math.max(high, value);
    }
  }
  return [low, high];
}
