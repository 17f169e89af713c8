// Drives the page of `hertzian explore` in headless Chromium:
//
//     node drive.mjs PROGRAM CHROMIUM [PICTURES]
//
// PROGRAM is the built `hertzian`. With a folder PICTURES it takes pictures of the page there. EXPLORE_SECONDS says how long a thousand requests a
// second are sent (default 2), EXPLORE_DRAGS how often a slider is let go to measure the exact answer (default 3).

import assert from 'node:assert/strict';
import { execFile, spawn } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import http from 'node:http';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { promisify } from 'node:util';

import { Browser } from './browser.mjs';

const [program, chromium, pictures] = process.argv.slice(2);
const SECONDS = Number(process.env.EXPLORE_SECONDS ?? 2);
const DRAGS = Number(process.env.EXPLORE_DRAGS ?? 3);
const RATE = 1000;
const pause = (milliseconds) => new Promise((done) => setTimeout(done, milliseconds));

class Served {
  static async begin(port = 0, words = []) {
    const served = new Served();
    served.child = spawn(program, ['explore', '--port', String(port), ...words], { stdio: ['ignore', 'pipe', 'inherit'] });
    const line = await new Promise((done, fail) => {
      let text = '';
      served.child.stdout.on('data', (data) => {
        text += data;
        if (text.includes('\n')) done(text.trim());
      });
      served.child.once('exit', () => fail(new Error('the program ended')));
    });
    served.url = line;
    served.port = Number(new URL(line).port);
    return served;
  }

  async kill() {
    const gone = new Promise((done) => this.child.once('exit', done));
    this.child.kill('SIGKILL');
    await gone;
  }
}

// The exact curve is drawn, and nothing is under way.
const READY = `document.querySelector('#curve')?.classList.contains('exact') && document.querySelector('#status').textContent === ''`;
const ready = (page, what = 'an exact curve') => page.until(READY, what, 60_000);
const texts = (page, selector) => page.value(`[...document.querySelectorAll(${JSON.stringify(selector)})].map((e) => e.textContent)`);
const marks = (page, name) => page.value(`performance.getEntriesByName(${JSON.stringify(name)}).map((m) => m.startTime)`);
const events = (page) => page.value(`[...document.querySelectorAll('#events button')].map((b) => [...b.childNodes].filter((n) => n.nodeType === 3).map((n) => n.data).join('').trim())`);

async function command(page, more = []) {
  const words = (await page.value(`document.querySelector('#command').value`)).split(' ').slice(1);
  const { stdout } = await promisify(execFile)(program, [...words, ...more], { maxBuffer: 1 << 26 });
  return stdout;
}

// Where the knob of a slider is, and how far a part of its range is from there.
async function slider(page, name) {
  return page.value(`(() => { const e = document.querySelector('[data-slider="${name}"]'); e.scrollIntoView({ block: 'center' }); const b = e.getBoundingClientRect(); const part = e.value / e.max; return { x: b.x + 8 + part * (b.width - 16), y: b.y + b.height / 2, width: b.width - 16, left: b.x + 8 }; })()`);
}

// Drags a slider back and forth for so long, as a hand does, and lets it go in a new place; gives back where that is.
async function drag(page, name, milliseconds, part) {
  const { x, y, width, left } = await slider(page, name);
  await page.mouse('mouseMoved', x, y);
  await page.mouse('mousePressed', x, y, 1);
  const begun = Date.now();
  let count = 0;
  while (Date.now() - begun < milliseconds) {
    const swing = 0.5 - 0.5 * Math.cos((count * Math.PI) / 40);
    await page.mouse('mouseMoved', left + width * (part + 0.15 * swing), y, 1);
    count += 1;
    await pause(8);
  }
  await page.mouse('mouseMoved', left + width * part, y, 1);
  await page.mouse('mouseReleased', left + width * part, y);
  return count;
}

const steps = [];
const step = (name, run) => steps.push({ name, run });
const measured = [];

step('it loads', async ({ page }) => {
  await ready(page);
  assert.equal(await page.value(`document.querySelectorAll('.parameter').length`), 4);
  assert.ok((await page.value(`document.querySelectorAll('#curve path.unstable').length`)) > 0);
  assert.ok((await page.value(`document.querySelectorAll('#curve path.stable').length`)) > 1);
  assert.equal(await page.value(`document.documentElement.scrollWidth <= innerWidth`), true);
});

step('its numbers are those of the command that it shows', async ({ page }) => {
  const printed = await command(page, ['--svg', '/dev/null', '--at', '1.1']);
  const folds = printed.split('\n').filter((line) => line.startsWith('fold ')).map((line) => line.replace(/^fold +omega /, 'fold at '));
  assert.deepEqual((await events(page)).filter((text) => text.startsWith('fold')), folds);
  await page.until(`location.hash.length > 1`, 'a state in the address');
  await page.value(`(() => { location.hash = '#' + encodeURIComponent(JSON.stringify({ ...JSON.parse(decodeURIComponent(location.hash.slice(1))), at: 1.1 })); })()`);
  await page.until(`document.querySelectorAll('#solutions button').length === 3 && !document.querySelector('#orbit').classList.contains('old')`, 'three motions');
  const sizes = printed.split('\n').filter((line) => line.startsWith('at ')).map((line) => line.split('peak-to-peak ')[1].split(', '));
  assert.deepEqual(await texts(page, '#solutions button'), sizes.map(([size, verdict]) => `${verdict}, peak-to-peak of x ${size}`));
});

step('a slider drags the curve', async ({ page }) => {
  for (let turn = 0; turn < DRAGS; turn += 1) {
    await page.value(`performance.clearMarks()`);
    const moves = await drag(page, 'load', 1500, turn % 2 === 0 ? 0.3 : 0.4);
    await page.until(`performance.getEntriesByName('drawn-full').some((m) => m.startTime > performance.getEntriesByName('released')[0]?.startTime)`, 'the exact curve after release');
    const drawn = await marks(page, 'drawn-screen');
    const [released] = await marks(page, 'released');
    const exact = (await marks(page, 'drawn-full')).find((time) => time > released);
    const rate = (1000 * (drawn.length - 1)) / (drawn[drawn.length - 1] - drawn[0]);
    measured.push({ moves, rate, exact: exact - released });
    assert.ok(drawn.length > 3, `${drawn.length} curves`);
  }
  await ready(page);
  assert.ok((await page.value(`document.querySelectorAll('.shadow path').length`)) > 0, 'a shadow');
  // What is drawn is the curve of the value that is shown.
  const value = await page.value(`document.querySelector('#parameter-load').value`);
  assert.match(await page.value(`document.querySelector('#command').value`), new RegExp(`--set load=${value.replace('.', '\\.')} `));
  const folds = (await command(page, ['--svg', '/dev/null'])).split('\n').filter((line) => line.startsWith('fold ')).map((line) => line.replace(/^fold +omega /, 'fold at '));
  assert.deepEqual((await events(page)).filter((text) => text.startsWith('fold')), folds);
  await page.press('#defaults');
  await page.until(`document.querySelector('#command').value.includes('--set load=1 ')`, 'defaults');
  await ready(page);
});

step('a click shows the motions', async ({ page }) => {
  // In the middle between two folds, on the upper stable branch.
  const [x, y] = await page.value(`(() => { const c = document.querySelector('#chart'); c.scrollIntoView(); const path = [...document.querySelectorAll('#curve path.stable')].pop(); const p = path.getPointAtLength(path.getTotalLength() * 0.4); const b = c.getBoundingClientRect(); return [b.x + p.x, b.y + p.y]; })()`);
  await page.value(`performance.clearMarks()`);
  await page.click(x, y);
  await page.until(`performance.getEntriesByName('drawn-orbits').length > 0`, 'motions');
  assert.deepEqual(await page.value(`[...document.querySelectorAll('[data-panel]')].map((f) => f.dataset.panel)`), ['play', 'history', 'phase', 'force', 'spectrum', 'multipliers']);
  assert.equal(await page.value(`document.querySelectorAll('#solutions [aria-pressed=true]').length`), 1);
  assert.ok((await page.value(`document.querySelectorAll('[data-panel=history] .shade').length`)) > 0, 'contact is shaded');
  assert.equal(await page.value(`document.querySelectorAll('[data-panel=multipliers] .multiplier').length`), 2);
  assert.match(await page.value(`document.querySelector('#verdict').textContent`), /largest multiplier has the modulus 0\.\d+ \(error \S+\)/);
  // The motion plays: two pictures of it differ.
  const painted = `document.querySelector('canvas').toDataURL()`;
  const first = await page.value(painted);
  await page.until(`${painted} !== ${JSON.stringify(first)}`, 'the motion moves');
  await page.value(`document.querySelector('#chart').focus()`);
  const before = await page.value(`document.querySelector('#orbit-title').textContent`);
  await page.send('Input.dispatchKeyEvent', { type: 'keyDown', key: 'ArrowRight', code: 'ArrowRight', windowsVirtualKeyCode: 39 });
  await page.until(`document.querySelector('#orbit-title').textContent !== ${JSON.stringify(before)}`, 'the next value by a key');
});

step('a click on an event shows the motion there', async ({ page }) => {
  const [x, y] = await page.value(`(() => { const b = document.querySelector('#marks [data-event="0"]').getBoundingClientRect(); return [b.x + b.width / 2, b.y + b.height / 2]; })()`);
  const [first] = await events(page);
  await page.click(x, y);
  await page.until(`document.querySelector('#orbit-title').textContent.includes('1.1445169')`, 'the fold');
  const size = first.split('peak-to-peak ')[1].slice(0, 7);
  assert.ok((await texts(page, '#solutions [aria-pressed=true]'))[0].includes(size));
});

step('no answer to what was asked before is shown', async ({ page }) => {
  const set = (value) => page.value(`(() => { const t = document.querySelector('#parameter-load'); t.value = '${value}'; t.dispatchEvent(new Event('change')); })()`);
  const [x, y] = await page.middle('#chart');
  await page.click(x, y);
  for (const value of [0.7, 1.3, 0.8, 1.1]) await set(value);
  await page.until(`document.querySelector('#command').value.includes('--set load=1.1 ')`, 'the last value');
  await ready(page);
  await page.until(`!document.querySelector('#orbit').classList.contains('old')`, 'its motions');
  // The command asks for the motions at this place.
  const printed = await command(page, ['--svg', '/dev/null']);
  const sizes = printed.split('\n').filter((line) => line.startsWith('at ')).map((line) => line.split('peak-to-peak ')[1].split(', '));
  assert.deepEqual(await texts(page, '#solutions button'), sizes.map(([size, verdict]) => `${verdict}, peak-to-peak of x ${size}`));
  await set(1);
  await page.until(`document.querySelector('#command').value.includes('--set load=1 ')`, 'the load as it was');
  await ready(page);
});

const edit = (page, from, to) => page.value(`(() => { const t = document.querySelector('#text'); t.value = t.value.replace(${JSON.stringify(from)}, ${JSON.stringify(to)}); t.dispatchEvent(new Event('input')); })()`);

step('a mistake in the declaration is shown at its place', async ({ page }) => {
  await edit(page, 'gap^alpha', 'gap^alfa');
  await page.until(`document.querySelectorAll('#messages li').length === 1`, 'a message');
  const [message] = await texts(page, '#messages button');
  assert.match(message, /^line 13, column 42: .*`alfa`/);
  assert.deepEqual(await texts(page, '#underlay mark'), ['alfa']);
  await edit(page, 'gap^alfa', 'gap^alpha + 0*gap');
  await page.until(`document.querySelectorAll('#messages li').length === 0`, 'no message');
  await ready(page);
  await edit(page, 'gap^alpha + 0*gap', 'gap^alpha');
  await page.until(`document.querySelector('#described').textContent !== 'edited'`, 'the model by its name');
  await ready(page);
});

step('a value out of its range is said at its field', async ({ page }) => {
  const set = (value) => page.value(`(() => { const t = document.querySelector('#parameter-zeta'); t.value = '${value}'; t.dispatchEvent(new Event('change')); })()`);
  await set('-1');
  await page.until(`document.querySelector('[data-field=zeta] .here-fault')?.textContent.includes('outside its range')`, 'a sentence at the field');
  await set('0.032');
  await page.until(`document.querySelectorAll('.here-fault').length === 0`, 'no sentence');
  await ready(page);
});

step('texts of a declaration stay texts', async ({ page }) => {
  const evil = 'Evil(x) {\n/// <img src=x onerror="document.title=1"><script>document.title=2</script>\nparam k = 1 > 0;\nddot(x) + 0.1*dot(x) + k*x = cos(omega*t);\n}';
  await page.value(`(() => { const t = document.querySelector('#text'); t.value = ${JSON.stringify(evil)}; t.dispatchEvent(new Event('input')); })()`);
  await page.until(`document.querySelector('.about')?.textContent.includes('<img')`, 'the documentation as it is written');
  await ready(page);
  assert.equal(await page.value(`document.querySelectorAll('main img, main script').length`), 0);
  assert.equal(await page.value(`document.title`), 'hertzian explore');
  await page.value(`(() => { const s = document.querySelector('#model'); s.value = 'one-sided'; s.dispatchEvent(new Event('change')); })()`);
  await page.until(`document.querySelectorAll('.parameter').length === 4`, 'the model again');
  await ready(page);
});

step('files are exported as the command writes them', async ({ page, browser, folder }) => {
  await browser.send('Browser.setDownloadBehavior', { behavior: 'allow', downloadPath: folder });
  const written = join(folder, 'command.csv');
  await command(page, ['--svg', join(folder, 'command.svg'), '--csv', written]);
  for (const [form, name] of [['svg', 'response.svg'], ['csv', 'response.csv'], ['json', 'response.json'], ['rust', 'main.rs']]) {
    await page.press(`[data-form=${form}]`);
    await page.until(`document.querySelector('#export-said').textContent.startsWith(${JSON.stringify(name)})`, name);
    const end = Date.now() + 5000;
    const bytes = () => { try { return readFileSync(join(folder, name), 'utf8'); } catch { return ''; } };
    while (bytes() === '' && Date.now() < end) await pause(20);
    const text = bytes();
    if (form === 'csv') assert.equal(text, readFileSync(written, 'utf8'));
    if (form === 'svg') assert.equal(text, readFileSync(join(folder, 'command.svg'), 'utf8'));
    if (form === 'json') assert.equal(JSON.parse(text).branches.length, 1);
    if (form === 'rust') assert.match(text, /FrequencyResponse::of\(&model\)/);
  }
});

step('measured values are dropped and fitted', async ({ page }) => {
  await ready(page);
  // The curve of another damping and load, from its own orbits.
  const { text } = await page.value(`fetch('/models').then((r) => r.json()).then((all) => all[0])`);
  const of = { text, varied: 'omega', from: 0.6, to: 1.6, values: { zeta: 0.05, load: 1.2 } };
  const lines = await page.value(`fetch('/ask', { method: 'POST', headers: { 'Content-Type': 'application/json' }, body: ${JSON.stringify(JSON.stringify({ client: 'data', ask: { curve: { of, plot: 'x:p2p', effort: 'full' } } }))} }).then((r) => r.text())`);
  const orbits = JSON.parse(lines.trim().split('\n').pop()).curve.branches[0].orbits.filter(([, , verdict]) => verdict === 'stable').filter((_, i) => i % 5 === 0);
  const table = `omega, x:p2p\n${orbits.map(([omega, size]) => `${omega}, ${size}`).join('\n')}\n`;
  const drop = (contents) => page.value(`(() => { const d = new DataTransfer(); d.items.add(new File([${JSON.stringify(contents)}], 'data.csv')); window.dispatchEvent(new DragEvent('drop', { dataTransfer: d, cancelable: true })); })()`);
  await drop('omega, nothing:p2p\n1, 2\n');
  await page.until(`document.querySelector('#fit-fault').textContent.includes('nothing')`, 'what is wrong with a table');
  await drop(table);
  await page.until(`document.querySelectorAll('#values circle').length === ${orbits.length}`, 'the values over the curve');
  await page.value(`(() => { for (const name of ['zeta', 'load']) document.querySelector('#free input[value=' + name + ']').click(); document.querySelector('#fit').click(); })()`);
  await page.until(`!document.querySelector('#fitted').hidden`, 'a fit', 60_000);
  await ready(page);
  const [zeta, load] = await page.value(`['zeta', 'load'].map((name) => Number(document.querySelector('#parameter-' + name).value))`);
  assert.ok(Math.abs(zeta - 0.05) < 1e-4 && Math.abs(load - 1.2) < 1e-3, `${zeta} ${load}`);
  await page.press('#no-data');
  assert.equal(await page.value(`document.querySelectorAll('#values circle').length`), 0);
  await page.press('#defaults');
  await page.until(`document.querySelector('#command').value.includes('--set load=1 ')`, 'defaults');
  await ready(page);
});

step('the address restores the state, and two pages do not disturb each other', async ({ page, browser, pages }) => {
  await page.value(`(() => { const t = document.querySelector('#parameter-drive'); t.value = '0.12'; t.dispatchEvent(new Event('change')); const y = document.querySelector('#yscale'); y.value = 'db'; y.dispatchEvent(new Event('change')); })()`);
  await page.until(`document.querySelector('#command').value.includes('--set drive=0.12 ')`, 'the other drive');
  await ready(page);
  await pause(250);
  const other = await browser.page(await page.value(`location.href`));
  pages.push(other);
  await ready(other);
  assert.equal(await other.value(`document.querySelector('#parameter-drive').value`), '0.12');
  assert.equal(await other.value(`document.querySelector('#yscale').value`), 'db');
  assert.deepEqual(await events(other), await events(page));
  await Promise.all([drag(page, 'load', 600, 0.2), drag(other, 'load', 600, 0.5)]);
  const load = (own) => own.value(`document.querySelector('#parameter-load').value`);
  for (const own of [page, other]) {
    await own.until(`document.querySelector('#command').value.includes('--set load=${await load(own)} ')`, 'the curve of its own load');
    await ready(own);
  }
  assert.notEqual(await load(page), await load(other));
  await page.press('#pin');
  assert.equal(await page.value(`document.querySelectorAll('#pins li').length`), 1);
  await other.close();
});

step('ten million bytes are refused in a sentence', async ({ page }) => {
  const { status, fault } = await page.value(`(async () => { const r = await fetch('/ask', { method: 'POST', headers: { 'Content-Type': 'application/json' }, body: 'x'.repeat(10_000_000) }); return { status: r.status, fault: (await r.json()).fault.message }; })()`);
  assert.equal(status, 413);
  assert.match(fault, /^the request is larger than 1048576 bytes/);
  page.faults.length = 0; // The browser says that as well.
});

step(`${RATE} requests a second for ${SECONDS} s`, async ({ page, served }) => {
  const agent = new http.Agent({ keepAlive: true, maxSockets: 64 });
  const { text } = (await (await fetch(`${served.url}models`)).json())[0];
  const counts = {};
  const send = (number) => new Promise((done) => {
    const of = { text, varied: 'omega', from: 0.6, to: 1.6, values: { load: 1 + (number % 97) / 100 } };
    const asks = [{ declaration: { text: `${text} // ${number % 3}` } }, { curve: { of, plot: '', effort: 'screen' } }, { orbits: { of, plot: '', at: 1.1 } }, { curve: { of, plot: 'x:h1', effort: 'full' } }];
    const body = JSON.stringify({ client: `c${number % 5}`, ask: asks[number % asks.length] });
    const request = http.request(`${served.url}ask`, { method: 'POST', agent, headers: { 'Content-Type': 'application/json', 'Content-Length': Buffer.byteLength(body) } }, (response) => {
      let last = '';
      response.on('data', (data) => { last = (last + data).slice(-1 << 20); });
      response.on('end', () => {
        const line = JSON.parse(last.trim().split('\n').pop());
        const key = line.fault ? line.fault.kind : 'answered';
        counts[key] = (counts[key] ?? 0) + 1;
        done();
      });
    });
    request.on('error', () => { counts.broken = (counts.broken ?? 0) + 1; done(); });
    request.end(body);
  });
  const begun = Date.now();
  const all = [];
  while (Date.now() - begun < 1000 * SECONDS) {
    const due = (RATE * (Date.now() - begun)) / 1000;
    while (all.length < due) all.push(send(all.length));
    await pause(2);
  }
  await Promise.all(all);
  agent.destroy();
  const seconds = (Date.now() - begun) / 1000;
  console.log(`   ${all.length} requests, answered after ${seconds.toFixed(1)} s: ${JSON.stringify(counts)}`);
  assert.ok(counts.answered > 0);
  assert.deepEqual(Object.keys(counts).filter((key) => !['answered', 'cancelled', 'busy'].includes(key)), []);
  await page.press('#defaults');
  await ready(page);
});

step('where the program is gone the page says so, and goes on when it is back', async (all) => {
  const { page, served } = all;
  await served.kill();
  await page.value(`(() => { const t = document.querySelector('#parameter-load'); t.value = '1.5'; t.dispatchEvent(new Event('change')); })()`);
  await page.until(`!document.querySelector('#lost').hidden`, 'what is said of it');
  assert.match(await page.value(`document.querySelector('#lost').textContent`), /does not answer/);
  all.served = await Served.begin(served.port);
  await page.until(`document.querySelector('#lost').hidden`, 'it is back');
  await page.until(`document.querySelector('#command').value.includes('--set load=1.5 ')`, 'the curve of the new value');
  await ready(page);
  page.faults.length = 0; // The browser says that as well.
});

step('a model from a file is explored as the command computes it', async ({ browser, folder }) => {
  const file = join(folder, 'stop.txt');
  writeFileSync(file, 'Stop(x) {\n    /// stiffness of the stop\n    param k = 4 in 1e-2..1e4;\n    ddot(x) + 0.1*dot(x) + x + H(x - 1)*k*(x - 1) = 0.3*cos(omega*t);\n}\n');
  const served = await Served.begin(0, [file, '--set', 'k=20', '--from', '0.7', '--to', '2']);
  try {
    const page = await browser.page(served.url);
    await ready(page);
    assert.equal(await page.value(`document.querySelector('#parameter-k').value`), '20');
    // Six decades are a slider over decades.
    assert.equal(await page.value(`document.querySelector('[data-field=k] input[type=checkbox]').checked`), true);
    assert.match(await page.value(`document.querySelector('#command').value`), /--set k=20 --from 0\.7 --to 2/);
    const printed = await command(page, ['--svg', '/dev/null']);
    const folds = printed.split('\n').filter((line) => line.startsWith('fold ')).map((line) => line.replace(/^fold +omega /, 'fold at '));
    // Those of the branch that was asked for come first; of one that was joined the command lists them below.
    assert.equal(folds.length, 2);
    assert.deepEqual((await events(page)).filter((text) => text.startsWith('fold')).slice(0, 2), folds);
    await page.close();
  } finally {
    await served.kill();
  }
});

// Pictures to be looked at, none of which is compared.
step('pictures', async ({ browser, served }) => {
  if (!pictures) return;
  const at = (state) => `${served.url}#${encodeURIComponent(JSON.stringify(state))}`;
  const fig = { name: 'one-sided', at: 1.1 };
  const chaos = { name: 'one-sided', values: { alpha: 1, drive: 1.885, zeta: 0.032, load: 1 }, from: 0.9, to: 1.1, at: 1 };
  const two = { name: 'two-masses', from: 0.8, to: 1.7, yscale: 'db', at: 1.05 };
  for (const [name, state, options] of [['desktop', fig, {}], ['phone', fig, { width: 390, height: 844, phone: true }], ['dark', fig, { dark: true }], ['two-coordinates', two, {}], ['chaotic', chaos, {}]]) {
    const page = await browser.page(at(state), options);
    await ready(page);
    await page.until(`!document.querySelector('#orbit').hidden && !document.querySelector('#orbit').classList.contains('old')`, 'motions', 60_000);
    await pause(300);
    assert.equal(await page.value(`document.documentElement.scrollWidth <= innerWidth`), true, `${name} fits`);
    await page.picture(join(pictures, `${name}.png`), true);
    await page.close();
  }
  const page = await browser.page(at(fig), {});
  await ready(page);
  await edit(page, 'gap^alpha', 'gap^alfa');
  await page.until(`document.querySelectorAll('#messages li').length === 1`, 'a message');
  await page.value(`document.querySelector('#declared').scrollIntoView()`);
  await page.picture(join(pictures, 'error.png'));
  await page.close();
});

const folder = mkdtempSync(join(tmpdir(), 'explored-'));
const all = { served: await Served.begin(), browser: new Browser(chromium), pages: [], folder };
let failed = 0;
try {
  all.page = await all.browser.page(all.served.url);
  all.pages.push(all.page);
  for (const { name, run } of steps) {
    const begun = Date.now();
    await run(all);
    assert.deepEqual(all.pages.flatMap((page) => page.faults), [], 'the browser has nothing to say');
    console.log(`ok ${name} (${((Date.now() - begun) / 1000).toFixed(1)} s)`);
  }
} catch (error) {
  failed = 1;
  console.error(`failed: ${error.stack}`);
  await all.page?.picture(join(tmpdir(), 'explore-failed.png')).catch(() => {});
} finally {
  await all.browser.close().catch(() => {});
  await all.served.kill().catch(() => {});
  rmSync(folder, { recursive: true, force: true });
}
for (const { moves, rate, exact } of measured) console.log(`dragged: ${moves} moves, ${rate.toFixed(0)} curves a second; exact ${exact.toFixed(0)} ms after release`);
process.exit(failed);
