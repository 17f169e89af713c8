// The declaration, with what is wrong at its place.

import { byId, el } from './dom.js';

const text = () => byId('text');

// As large as what is in it: the box around scrolls.
function fit() {
  const area = text();
  area.style.height = 'auto';
  area.style.height = `${area.scrollHeight + 2}px`;
  area.style.width = '100%';
  area.style.width = `${Math.max(area.scrollWidth, area.clientWidth)}px`;
}

export function put(contents) {
  if (text().value !== contents) text().value = contents;
  show([]);
}

// Marks of the faults: a wavy line under the word, the first sentence beside the line, all of them below.
export function show(places) {
  const lines = text().value.split('\n');
  const parts = [];
  lines.forEach((contents, index) => {
    const here = places.filter((place) => place.line === index + 1).sort((a, b) => a.column - b.column);
    const letters = [...contents];
    let done = 0;
    for (const place of here) {
      const start = Math.min(Math.max(place.column - 1, done), letters.length);
      let end = start + 1;
      while (end < letters.length && /\w/.test(letters[start]) && /\w/.test(letters[end])) end += 1;
      parts.push(letters.slice(done, start).join(''));
      parts.push(el('mark', { title: place.message, text: letters.slice(start, end).join('') || ' ' }));
      done = Math.min(end, letters.length);
    }
    parts.push(letters.slice(done).join(''));
    if (here.length > 0) parts.push(el('span', { class: 'beside', text: `   ◂ ${here[0].message}` }));
    parts.push('\n');
  });
  byId('underlay').replaceChildren(...parts);
  byId('last-fine').hidden = places.length === 0;
  byId('messages').replaceChildren(...places.map((place) => el('li', {}, el('button', {
    type: 'button',
    text: `line ${place.line}, column ${place.column}: ${place.message}`,
    onclick: () => go(place),
  }))));
  fit();
}

function go(place) {
  const lines = text().value.split('\n').slice(0, place.line - 1);
  const line = [...(text().value.split('\n')[place.line - 1] ?? '')];
  const start = lines.reduce((sum, contents) => sum + contents.length + 1, 0) + line.slice(0, place.column - 1).join('').length;
  text().focus();
  text().setSelectionRange(start, start + 1);
}

// Calls `changed` when typing pauses.
export function listen(changed) {
  let timer = null;
  text().addEventListener('input', () => {
    fit();
    clearTimeout(timer);
    timer = setTimeout(() => changed(text().value), 120);
  });
  text().addEventListener('keydown', (event) => {
    if (event.key === 'Tab' && !event.shiftKey && !event.altKey && !event.ctrlKey && text().dataset.escaped !== 'yes') {
      event.preventDefault();
      text().setRangeText('    ', text().selectionStart, text().selectionEnd, 'end');
      text().dispatchEvent(new Event('input'));
    }
    // After Escape the tabulator leads out again.
    text().dataset.escaped = event.key === 'Escape' ? 'yes' : 'no';
  });
}
