// Requests to the program. Of each kind the newest alone is wanted: an older one is given up, here and there.

const client = crypto.randomUUID ? crypto.randomUUID() : String(Math.random()).slice(2);
const running = new Map();
let number = 0;

// Thrown where a newer request has taken the place of this one.
export class Superseded extends Error {}
// Thrown where nobody answers.
export class Lost extends Error {}

// What the program says of a request that it cannot do: a sentence, and where it belongs.
export class Refused extends Error {
  constructor(fault) {
    super(fault.message);
    this.fault = fault;
  }
}

// Asks, and hands on every line of the answer; gives back the last one.
export async function ask(lane, what, onLine = () => {}) {
  running.get(lane)?.abort();
  const mine = new AbortController();
  running.set(lane, mine);
  number += 1;
  const current = () => running.get(lane) === mine;
  try {
    const response = await fetch('/ask', {
      method: 'POST',
      headers: { 'Content-Type': 'application/json' },
      body: JSON.stringify({ client, number, ask: what }),
      signal: mine.signal,
    });
    const reader = response.body.getReader();
    const decoder = new TextDecoder();
    let rest = '';
    let last = null;
    for (;;) {
      const { done, value } = await reader.read();
      rest += done ? decoder.decode() : decoder.decode(value, { stream: true });
      const lines = rest.split('\n');
      rest = done ? '' : lines.pop();
      for (const text of lines) {
        if (text.trim() === '') continue;
        if (!current()) throw new Superseded();
        last = JSON.parse(text);
        if (last.fault) {
          if (last.fault.kind === 'cancelled') throw new Superseded();
          throw new Refused(last.fault);
        }
        onLine(last);
      }
      if (done) break;
    }
    if (last === null) throw new Lost('the answer is empty');
    return last;
  } catch (error) {
    if (!current() || error.name === 'AbortError') throw new Superseded();
    if (error instanceof Superseded || error instanceof Refused) throw error;
    throw new Lost(error.message);
  } finally {
    if (current()) running.delete(lane);
  }
}

export async function models() {
  let response;
  try {
    response = await fetch('/models');
  } catch (error) {
    throw new Lost(error.message);
  }
  if (!response.ok) throw new Refused((await response.json()).fault);
  return response.json();
}
