// The motion as it is: masses at their places, surfaces where contacts begin, over and over.

import { evenTicks, extent } from './axes.js';
import { inUnit, short } from './dom.js';

const SECONDS = 3; // for one period of the excitation
const SCALE = 52; // pixels for the numbers at the left

let frameId = null;

function at(times, values, time) {
  let low = 0;
  let high = times.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= time) low = middle;
    else high = middle;
  }
  const span = times[high] - times[low];
  const part = span > 0 ? (time - times[low]) / span : 0;
  return values[low] + part * (values[high] - values[low]);
}

const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

// Positions are told at the left, and zero by a line, where all coordinates have one unit.
function scale(context, orbit, { low, high, y, width }) {
  const [{ unit }] = orbit.motions;
  if (orbit.motions.some((motion) => motion.unit !== unit)) return;
  context.font = '11px system-ui, sans-serif';
  context.textAlign = 'right';
  context.fillStyle = colour('--soft');
  context.strokeStyle = colour('--line');
  context.lineWidth = 1;
  for (const value of evenTicks(low, high, 5).filter((own) => y(own) > 22)) {
    context.fillText(short(value, 4), SCALE - 12, y(value) + 4);
    context.beginPath();
    context.moveTo(SCALE - 8, y(value));
    context.lineTo(value === 0 ? width : SCALE - 2, y(value));
    context.stroke();
  }
  context.textAlign = 'left';
  context.fillText(inUnit('position', unit), 2, 12);
}

function paint(canvas, orbit, time) {
  const { width, height } = canvas.getBoundingClientRect();
  const ratio = devicePixelRatio || 1;
  if (canvas.width !== Math.round(width * ratio)) canvas.width = Math.round(width * ratio);
  if (canvas.height !== Math.round(height * ratio)) canvas.height = Math.round(height * ratio);
  const context = canvas.getContext('2d');
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, width, height);
  const surfaces = orbit.contacts.filter((contact) => contact.surface !== null);
  const all = orbit.motions.flatMap((motion) => motion.positions).concat(surfaces.map((contact) => contact.surface[2]));
  let [low, high] = extent(all);
  const pad = 0.18 * (high - low || 1);
  [low, high] = [low - pad, high + pad];
  // A positive coordinate points down, as a mass is pressed onto what is under it.
  const y = (value) => 30 + ((value - low) / (high - low)) * (height - 44);
  scale(context, orbit, { low, high, y, width });
  const slot = (width - SCALE) / orbit.motions.length;
  orbit.motions.forEach((motion, index) => {
    const middle = SCALE + slot * (index + 0.5);
    const size = Math.min(15, slot / 6);
    const own = surfaces.filter((candidate) => candidate.surface[0] === index);
    // With surfaces on one side alone, the face that meets them is where the coordinate is.
    const sides = own.map((contact) => Math.sign(contact.surface[1]));
    const shift = sides.every((side) => side === sides[0]) ? -(sides[0] ?? 0) * size : 0;
    const position = y(at(motion.times, motion.positions, time)) + shift;
    for (const contact of own) {
      const [, factor, distance] = contact.surface;
      const level = y(distance) + shift;
      const under = factor > 0 ? 1 : -1;
      const touches = contact.closed.some(([from, to]) => time >= from && time <= to);
      context.strokeStyle = colour(touches ? '--accent' : '--soft');
      context.lineWidth = touches ? 3 : 1.5;
      // The surface gives way by as much as the mass presses into it.
      const edge = position + under * size;
      const wall = level + under * size;
      const pressed = touches ? (under > 0 ? Math.max(wall, edge) : Math.min(wall, edge)) : wall;
      const reach = Math.min(slot * 0.4, 90);
      context.beginPath();
      context.moveTo(middle - reach, wall);
      context.quadraticCurveTo(middle - size, wall, middle - size, pressed);
      context.lineTo(middle + size, pressed);
      context.quadraticCurveTo(middle + size, wall, middle + reach, wall);
      context.stroke();
      context.fillStyle = colour('--soft');
      context.font = '12px system-ui, sans-serif';
      context.textAlign = 'right';
      context.fillText(contact.name, middle + reach, wall + (under > 0 ? -6 : 14));
    }
    context.fillStyle = colour('--curve');
    context.fillRect(middle - size, position - size, 2 * size, 2 * size);
    context.fillStyle = colour('--soft');
    context.font = '12px system-ui, sans-serif';
    context.textAlign = 'center';
    context.fillText(motion.name, middle, 12);
  });
}

// Plays an orbit on a canvas; `each` is told the time. Another one takes its place.
export function play(canvas, orbit, each) {
  cancelAnimationFrame(frameId);
  const still = matchMedia('(prefers-reduced-motion: reduce)').matches;
  const perSecond = (2 * Math.PI) / orbit.omega / SECONDS;
  let time = 0;
  let before = null;
  let playing = !still;
  const step = (now) => {
    if (!canvas.isConnected) return;
    if (playing && before !== null) time = (time + ((now - before) / 1000) * perSecond) % orbit.duration;
    before = now;
    if (canvas.getBoundingClientRect().width > 0) {
      paint(canvas, orbit, time);
      each(time);
    }
    frameId = requestAnimationFrame(step);
  };
  frameId = requestAnimationFrame(step);
  return {
    toggle: () => {
      playing = !playing;
      return playing;
    },
    playing: () => playing,
  };
}
