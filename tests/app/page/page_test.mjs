// node page_test.mjs MAKE_PAGE DIR: opens generated report pages in a headless browser and looks at the pixels.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {existsSync, mkdirSync, mkdtempSync, rmSync, statSync, writeFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {pathToFileURL} from 'node:url';

const [makePage, folder] = process.argv.slice(2);
const modules = process.env.TOOTHPATH_PAGE_MODULES;
const chromium = [process.env.TOOTHPATH_CHROMIUM, '/usr/bin/chromium'].find((path) => path && existsSync(path));
if (!chromium || !modules || !existsSync(join(modules, 'puppeteer-core'))) {
  console.error('no browser or no puppeteer-core: run tools/get_page_tools.sh');
  process.exit(1);
}
const puppeteer = createRequire(join(modules, '../package.json'))('puppeteer-core');
mkdirSync(folder, {recursive: true});
const profile = mkdtempSync(join(tmpdir(), 'toothpath-page-'));
const flags = ['--no-sandbox', '--disable-gpu', '--enable-unsafe-swiftshader', '--disable-quic', '--no-first-run',
               '--disable-background-networking', '--disable-component-update', '--disable-sync'];
const browser = await puppeteer.launch({executablePath: chromium, userDataDir: profile, args: flags, protocolTimeout: 120000});

/** Opens a page of that kind; everything that it complains about is collected. */
async function open(kind, {width = 1280, height = 1000, dark = false, args = {}} = {}) {
  const file = join(folder, `${kind}.html`);
  execFileSync(makePage, [kind, file]);
  const page = await browser.newPage();
  const complaints = [];
  page.on('pageerror', (error) => complaints.push(error.message));
  page.on('console', (message) => { if (message.type() === 'error') complaints.push(message.text()); });
  page.on('request', (request) => { if (!/^(file|data|blob):/.test(request.url())) complaints.push(`asks for ${request.url()}`); });
  if (args.before) await page.evaluateOnNewDocument(args.before);
  await page.setViewport({width, height, deviceScaleFactor: 1, isMobile: width < 600, hasTouch: width < 600});
  await page.emulateMediaFeatures([{name: 'prefers-color-scheme', value: dark ? 'dark' : 'light'}]);
  await page.goto(pathToFileURL(file).href);
  await page.waitForFunction(() => !document.title.startsWith('Loading'), {timeout: 60000});
  await settle(page);
  return {page, complaints, file};
}

const settle = (page) => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));

/** Screenshot of one element, counted in another tab: [pixels, pixels for which `test` (r, g, b) holds ...]. */
async function counted(page, selector, name, tests) {
  const png = Buffer.from(await (await page.$(selector)).screenshot());
  writeFileSync(join(folder, name), png);
  const tab = await browser.newPage();
  const counts = await tab.evaluate(async (data, sources) => {
    const image = new Image();
    image.src = `data:image/png;base64,${data}`;
    await image.decode();
    const canvas = Object.assign(document.createElement('canvas'), {width: image.width, height: image.height});
    const context = canvas.getContext('2d');
    context.drawImage(image, 0, 0);
    const pixels = context.getImageData(0, 0, image.width, image.height).data;
    const functions = sources.map((source) => (0, eval)(source));
    const out = [image.width * image.height, ...functions.map(() => 0)];
    for (let i = 0; i < pixels.length; i += 4)
      functions.forEach((f, k) => { if (f(pixels[i], pixels[i + 1], pixels[i + 2])) out[k + 1]++; });
    return out;
  }, png.toString('base64'), tests.map(String));
  await tab.close();
  await page.bringToFront();
  return counts;
}

const background = (r, g, b) => Math.abs(r - 231) < 3 && Math.abs(g - 235) < 3 && Math.abs(b - 239) < 3;
const blue = (r, g, b) => b > r + 40;
const red = (r, g, b) => r > b + 60 && r > g + 60;
const gold = (r, g, b) => r > 120 && r > b + 60 && g > b + 30 && g < r - 10;

const tests = {
  async 'model, tool and legend are drawn'() {
    const {page, complaints} = await open('gouged');
    const [all, empty, blues, golds] = await counted(page, '.stage', 'gouged.png', [background, blue, gold]);
    assert.ok(empty > 0.2 * all && empty < 0.9 * all, `background ${empty} of ${all}`);
    assert.ok(blues > 0.02 * all, `blue ${blues} of ${all}`);
    assert.ok(golds > 300, `tool ${golds}`);
    const [bar, deep, left] = await counted(page, '#legend-bar', 'legend.png', [red, blue]);
    assert.ok(deep > 0.15 * bar && left > 0.15 * bar, `legend ${deep} red, ${left} blue of ${bar}`);
    const ticks = await page.$$eval('#legend-ticks span', (spans) => spans.map((s) => Number(s.textContent.replace('\u2212', '-'))));
    assert.equal(ticks.length, 5);
    assert.ok(ticks.every((v, i) => i === 0 || v > ticks[i - 1]) && ticks[0] === -ticks[4], `ticks ${ticks}`);
    assert.deepEqual(complaints, []);
    await page.close();
  },

  async 'a plain surface has no deviation colours and no legend'() {
    const {page, complaints} = await open('gouged');
    await page.select('#field', '-1');
    await page.select('#tool-mode', 'none');
    await page.select('#operation', '-1');
    await settle(page);
    const [all, , blues, golds] = await counted(page, '#view', 'plain.png', [background, blue, gold]);
    assert.ok(blues < 0.002 * all && golds < 50, `blue ${blues}, gold ${golds}`);
    assert.equal(await page.$eval('#legend', (e) => e.hidden), true);
    assert.deepEqual(complaints, []);
    await page.close();
  },

  async 'a gouge marker brings tool and listing to its NC line'() {
    const {page, complaints} = await open('gouged');
    const wanted = await page.$$eval('[data-row] td:last-child a', (links) => links.map((a) => Number(a.textContent)));
    assert.ok(wanted.length >= 5);
    for (const k of [0, 3]) {
      await page.$eval(`.marker:nth-child(${k + 1})`, (button) => button.click());
      await settle(page);
      assert.ok((await page.$eval('#record-note', (e) => e.textContent)).includes(`NC line ${wanted[k]}.`));
      assert.equal(await page.$eval('.listing .current a', (a) => Number(a.textContent)), wanted[k]);
      assert.ok(await page.$eval('.listing .current', (line) => {
        const own = line.getBoundingClientRect(), box = line.closest('.listing').getBoundingClientRect();
        return own.top >= box.top - 1 && own.bottom <= box.bottom + 1;
      }), `line ${wanted[k]} is out of the listing's window`);
      assert.equal(await page.$eval('tr.current', (row) => Number(row.dataset.row)), k);
    }
    assert.deepEqual(complaints, []);
    await page.close();
  },

  async 'axes over time and the plots of the study are there, with curves'() {
    for (const [kind, studied] of [['gouged', true], ['clean', false]]) {
      const {page, complaints} = await open(kind);
      const plots = await page.$$eval('#motion figure', (figures) => figures.map((f) => [f.querySelector('figcaption').textContent,
        [...f.querySelectorAll('path.cv')].reduce((n, p) => n + p.getAttribute('d').length, 0)]));
      assert.ok(plots.length >= 4, `${plots.length} plots`);
      for (const [title, length] of plots) assert.ok(length > 100, `${title}: a curve of ${length} characters`);
      assert.equal(await page.$eval('a[href="#motion"]', (a) => a.textContent), 'Axes');
      const dots = await page.$$eval('#work-precision circle.dot', (c) => c.length);
      assert.equal((await page.$('#work-precision')) !== null, studied, kind);
      assert.ok(!studied || dots >= 20, `${dots} runs of the study`);
      const [all, colours] = await counted(page, '#motion', `${kind}-motion.png`, [(r, g, b) => Math.max(r, g, b) - Math.min(r, g, b) > 60]);
      assert.ok(colours > 0.002 * all, `curves: ${colours} of ${all}`);
      assert.deepEqual(complaints, []);
      await page.close();
    }
  },

  async 'a chosen record shows its NC line and moves the tool'() {
    const {page, complaints} = await open('gouged');
    await page.select('#operation', '0');
    await page.select('#pass', '-1');
    const seen = [];
    for (const share of [0.2, 0.7]) {
      seen.push(await page.evaluate((at) => {
        const slider = document.getElementById('record');
        slider.value = Math.round(Number(slider.min) + at * (slider.max - slider.min));
        slider.dispatchEvent(new Event('input'));
        const {state, paths} = window.toothpathPage, path = paths[state.operation];
        return {record: state.record, wanted: Number(slider.value), line: path.line(state.record), tip: path.tip(state.record)};
      }, share));
      await settle(page);
      const last = seen.at(-1);
      assert.equal(last.record, last.wanted);
      assert.ok(last.line > 0);
      const note = await page.$eval('#record-note', (e) => e.textContent);
      assert.ok(note.includes(`NC line ${last.line}.`) && note.includes(`Record ${last.record + 1} of`), note);
      last.picture = Buffer.from(await (await page.$('#view')).screenshot()).toString('base64');
    }
    assert.notEqual(seen[0].line, seen[1].line);
    assert.notDeepEqual(seen[0].tip, seen[1].tip);
    assert.notEqual(seen[0].picture, seen[1].picture);
    assert.deepEqual(complaints, []);
    await page.close();
  },

  async 'work that is cut from below stands on its head'() {
    const {page, complaints} = await open('below');
    const {up, axis, tilted} = await page.evaluate(() => {
      const {camera, paths} = window.toothpathPage;
      return {up: camera.up(), axis: paths.at(-1).toolAxis(10), tilted: camera.down};
    });
    assert.ok(tilted && axis[2] < 0 && up[0] * axis[0] + up[1] * axis[1] + up[2] * axis[2] > 0, `up ${up}, tool ${axis}`);
    const [all, , blues, golds] = await counted(page, '#view', 'below.png', [background, blue, gold]);
    assert.ok(blues > 0.01 * all && golds > 100, `blue ${blues}, tool ${golds} of ${all}`);
    assert.deepEqual(complaints, []);
    await page.close();
  },

  async 'the gear stands on its machine, which moves, and gives way to the tooth space'() {
    const brass = (r, g, b) => r > 100 && r > b + 40 && g > b + 15 && r > g;
    const {page, complaints} = await open('machine');
    const shown = () => page.evaluate(() => [...document.querySelectorAll('#controls fieldset')].filter((f) => !f.hidden).map((f) => f.id));
    assert.deepEqual(await shown(), ['scene-controls', '', 'machine-controls']);
    const [all, empty, gear, blues] = await counted(page, '#view', 'machine.png', [background, brass, blue]);
    assert.ok(empty < 0.85 * all && gear > 0.02 * all && blues < 0.01 * all, `background ${empty}, gear ${gear}, blue ${blues} of ${all}`);
    // Tip of the tool against the work, as the chain says: A and C turn the table the other way.
    const off = await page.evaluate(() => {
      const {machine} = window.toothpathPage, [x, y, z, c, a] = [10, 20, 30, 0.3, -0.2];
      const places = machine.places([x, y, z, c, a]), p = Rigid.of(places[0], [7, 5, 3]);
      const about = [7 * Math.cos(c) + 5 * Math.sin(c), -7 * Math.sin(c) + 5 * Math.cos(c), 3 - 30];
      const wanted = [about[0], about[1] * Math.cos(a) + about[2] * Math.sin(a), -about[1] * Math.sin(a) + about[2] * Math.cos(a) + 30];
      return Math.max(Math.hypot(...Vec.sub(p, wanted)), Math.hypot(...Vec.sub(Rigid.of(places.at(-1), [0, 0, 0]), [x, y, z])));
    });
    assert.ok(off < 1e-9, `off by ${off}`);
    const picture = async () => Buffer.from(await (await page.$('#view')).screenshot()).toString('base64');
    // Play goes through the whole program, not on from the moment that the page chose to show.
    assert.ok(await page.evaluate(() => window.toothpathPage.moment > 11));
    await page.click('#run');
    assert.ok(await page.evaluate(() => window.toothpathPage.moment < 11));
    await page.click('#run');
    assert.deepEqual(await page.evaluate(() => [-127440.74, 725, -372.5, 0.001, -0.001].map(angle)),
                     ['\u22120.74\u00b0 (\u2212354 turns)', '5.00\u00b0 (+2 turns)', '\u2212372.50\u00b0', '0.00\u00b0', '0.00\u00b0']);
    const before = await picture();
    await page.$eval('#moment', (e) => { e.value = 3; e.dispatchEvent(new Event('input')); });
    await settle(page);
    assert.notEqual(await picture(), before);
    const note = await page.$eval('#moment-note', (e) => e.textContent);
    assert.ok(note.includes('NC line 109:') && note.includes('Z 157.00') && note.includes('C 3.44\u00b0'), note);
    assert.match(await page.$eval('#machine-note', (e) => e.textContent), /planted; the machine moves as read back, sampled/);
    // Another tooth: the machine turns to it, the moves are those of the first one with the index angle.
    await page.$eval('#tooth', (e) => { e.value = 7; e.dispatchEvent(new Event('change')); });
    await settle(page);
    const tooth = await page.evaluate(() => {
      const p = window.toothpathPage, s = p.atMoment(), first = p.timelines.first.at(Math.floor(p.moment) % 41);
      return {shown: document.getElementById('teeth-shown').value, off: s.joints[3] - first.joints[3] - 7 * 2 * Math.PI / 24, tooth: s.tooth,
              lines: s.line - first.line, length: p.timeline.length};
    });
    assert.ok(Math.abs(tooth.off) < 1e-5, `off by ${tooth.off}`);
    assert.deepEqual({...tooth, off: 0}, {shown: 'all', off: 0, tooth: 7, lines: 1400, length: 24 * 41});
    assert.match(await page.$eval('#moment-note', (e) => e.textContent), /tooth 7/);
    await page.select('#teeth-shown', 'first');
    await page.$eval('#moment', (e) => { e.value = 3; e.dispatchEvent(new Event('input')); });
    await page.click('#run');
    assert.ok(await page.evaluate(() => window.toothpathPage.moment >= 3), 'on from the moment that a reader chose');
    await page.waitForFunction(() => window.toothpathPage.moment > 4, {timeout: 20000});
    await page.click('#run');
    await page.click('#scene-flank');
    await settle(page);
    assert.deepEqual(await shown(), ['scene-controls', '', 'surface-controls', 'path-controls']);
    const [, , flank] = await counted(page, '#view', 'machine-flank.png', [background, blue]);
    assert.ok(flank > 0.02 * all, `blue ${flank}`);
    await page.click('#scene-machine');
    await page.$eval('[data-gouge]', (a) => a.click());
    assert.equal(await page.$eval('#path-controls', (f) => f.hidden), false);
    assert.deepEqual(complaints, []);
    await page.close();
  },

  async 'the machine on a phone and on paper'() {
    const {page, complaints} = await open('machine', {width: 390, height: 800});
    const [inner, scroll] = await page.evaluate(() => [document.documentElement.clientWidth, document.documentElement.scrollWidth]);
    assert.ok(scroll <= inner, `${scroll} wide on ${inner}`);
    await page.emulateMediaType('print');
    await page.evaluate(() => window.dispatchEvent(new Event('beforeprint')));
    await settle(page);
    const brass = (r, g, b) => r > 100 && r > b + 40 && g > b + 15 && r > g;
    const [all, gear] = await counted(page, '#view', 'machine-print.png', [brass]);
    assert.ok(gear > 0.01 * all, `gear ${gear} of ${all}`);
    assert.deepEqual(complaints, []);
    await page.close();
  },

  async 'mouse, wheel, slider and play change the picture or the record'() {
    const {page, complaints} = await open('clean');
    const state = () => page.evaluate(() => {
      const {camera, state: s} = window.toothpathPage;
      return {azimuth: camera.azimuth, elevation: camera.elevation, distance: camera.distance, target: [...camera.target], record: s.record};
    });
    await page.$eval('#view', (e) => e.scrollIntoView());
    const box = await (await page.$('#view')).boundingBox();
    const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
    const a = await state();
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + 60, y + 20);
    await page.mouse.up();
    const b = await state();
    assert.ok(b.azimuth < a.azimuth && b.elevation !== a.elevation && b.distance === a.distance);
    await page.mouse.wheel({deltaY: -300});
    await settle(page);
    const c = await state();
    assert.ok(c.distance < b.distance);
    await page.mouse.down({button: 'right'});
    await page.mouse.move(x + 100, y + 50);
    await page.mouse.up({button: 'right'});
    assert.notDeepEqual((await state()).target, c.target);
    await page.click('[data-view=reset]');
    assert.deepEqual(await state(), a);
    await page.$eval('#record', (e) => { e.value = e.min; e.dispatchEvent(new Event('input')); });
    const start = (await state()).record;
    await page.click('#play');
    await page.waitForFunction((from) => window.toothpathPage.state.record > from + 3, {timeout: 20000}, start);
    assert.deepEqual(complaints, []);
    await page.close();
  },

  async 'names with markup stay text'() {
    const {page, complaints} = await open('awkward');
    const title = await page.title();
    assert.ok(title.startsWith('</script><script>'), title);
    assert.equal(await page.$$eval('script', (s) => s.length), 3);
    assert.equal(await page.$$eval('main b', (s) => s.length), 0);
    assert.deepEqual(complaints, []);
    await page.close();
  },

  async 'a phone and a dark screen show the page without sideways scrolling'() {
    for (const [kind, options] of [['gouged', {width: 390, height: 800}], ['clean', {width: 390, height: 800, dark: true}], ['gouged', {dark: true}]]) {
      const {page, complaints} = await open(kind, options);
      const [inner, scroll] = await page.evaluate(() => [document.documentElement.clientWidth, document.documentElement.scrollWidth]);
      assert.ok(scroll <= inner, `${kind}: ${scroll} wide on ${inner}`);
      const [all, , blues] = await counted(page, '.stage', `${kind}-${options.width ?? 1280}${options.dark ? '-dark' : ''}.png`, [background, blue]);
      assert.ok(blues > 0.01 * all, `blue ${blues} of ${all}`);
      assert.deepEqual(complaints, []);
      await page.close();
    }
  },

  async 'without WebGL the page says so and keeps its plots'() {
    const before = () => { HTMLCanvasElement.prototype.getContext = () => null; };
    const {page, complaints} = await open('gouged', {args: {before}});
    assert.match(await page.title(), /no 3D view/);
    assert.match(await page.$eval('#message', (e) => e.textContent), /WebGL 2/);
    assert.ok((await page.$$('svg.plot')).length > 10);
    assert.deepEqual(complaints, []);
    await page.close();
  },

  async 'plots alone need no 3D view'() {
    const {page, complaints} = await open('plots');
    assert.equal(await page.$eval('#space', (e) => e.hidden), true);
    assert.deepEqual(complaints, []);
    await page.close();
  },

  async 'three hundred thousand points open in seconds'() {
    const start = Date.now();
    const {page, complaints, file} = await open('large', {width: 900, height: 700});
    await page.select('#pass', '-1');
    await settle(page);
    const points = await page.evaluate(() => window.toothpathPage.paths.reduce((n, p) => n + p.n, 0));
    console.log(`  ${points} points, ${(statSync(file).size / 1e6).toFixed(2)} MB, open and drawn in ${((Date.now() - start) / 1e3).toFixed(1)} s`);
    assert.ok(points > 280000 && statSync(file).size < 3e6);
    assert.deepEqual(complaints, []);
    await page.close();
  },
};

let failed = 0;
try {
  for (const [name, test] of Object.entries(tests)) {
    try {
      await test();
      console.log(`ok   ${name}`);
    } catch (error) {
      failed++;
      console.log(`FAIL ${name}\n${error.stack}`);
    }
  }
} finally {
  await browser.close();
  rmSync(profile, {recursive: true, force: true});
}
process.exit(failed ? 1 : 0);
