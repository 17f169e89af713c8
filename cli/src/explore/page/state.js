// Everything that a curve and its view are made of, and the same in the address of the page.

export const state = {
  name: '', // of the model, where its text is one that the program has
  text: '',
  values: {},
  ranges: {}, // of sliders: [low, high, logarithmic]
  varied: 'omega',
  from: 0.6,
  to: 1.6,
  omega: 1,
  period: 1,
  by: 'automatic',
  depth: null,
  plot: '',
  xscale: 'linear',
  yscale: 'linear',
  at: null,
};

// What the program is asked for; values of other models are left out.
export function asked(known) {
  const values = {};
  for (const name of known) if (Number.isFinite(state.values[name])) values[name] = state.values[name];
  const { text, varied, from, to, omega, period, by, depth } = state;
  return { text, values, varied, from, to, omega, period, by, depth };
}

const KINDS = {
  name: 'string', text: 'string', values: 'object', ranges: 'object', varied: 'string', from: 'number', to: 'number', omega: 'number',
  period: 'number', by: 'string', plot: 'string', xscale: 'string', yscale: 'string',
};

// Into the address, without a text that the program has.
export function toHash(models) {
  const kept = { ...state };
  if (models.some((model) => model.name === state.name && model.text === state.text)) delete kept.text;
  return `#${encodeURIComponent(JSON.stringify(kept))}`;
}

// From an address; false if it has no state.
export function fromHash(hash, models) {
  let read;
  try {
    read = JSON.parse(decodeURIComponent(hash.slice(1)));
  } catch {
    return false;
  }
  if (read === null || typeof read !== 'object') return false;
  const model = models.find((candidate) => candidate.name === read.name);
  if (typeof read.text !== 'string') read.text = model?.text;
  if (typeof read.text !== 'string') return false;
  for (const [name, kind] of Object.entries(KINDS)) if (typeof read[name] === kind && read[name] !== null) state[name] = read[name];
  if (!['linear', 'log'].includes(state.xscale)) state.xscale = 'linear';
  if (!['linear', 'log', 'db'].includes(state.yscale)) state.yscale = 'linear';
  state.at = typeof read.at === 'number' ? read.at : null;
  state.depth = typeof read.depth === 'number' ? read.depth : null;
  return true;
}

let keeping = null;

// Into the address, when changes pause.
export function keep(models) {
  clearTimeout(keeping);
  keeping = setTimeout(() => history.replaceState(null, '', toHash(models)), 150);
}
