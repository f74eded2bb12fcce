// Picture of a report page: node tools/page_screenshot.mjs FILE.html OUT.png [--width 1280] [--height 860] [--dark] [--full] [--select CSS] [--fits] [--pdf OUT.pdf]
// Needs tools/get_page_tools.sh once. Exit code 1 where the page reports an error or, with --fits, is wider than the window. --pdf prints it on A4, too.
import {createRequire} from 'node:module';
import {mkdtempSync, rmSync, existsSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join, resolve} from 'node:path';
import {fileURLToPath, pathToFileURL} from 'node:url';

const root = fileURLToPath(new URL('..', import.meta.url));
const require = createRequire(join(root, '.deps/page/package.json'));
const puppeteer = require('puppeteer-core');

const rest = process.argv.slice(2);
const take = (name, fallback) => {
  const at = rest.indexOf(name);
  return at < 0 ? fallback : rest.splice(at, 2)[1];
};
const flag = (name) => rest.includes(name) && rest.splice(rest.indexOf(name), 1).length > 0;
const width = Number(take('--width', 1280)), height = Number(take('--height', 860)), select = take('--select', ''), pdf = take('--pdf', '');
const dark = flag('--dark'), full = flag('--full'), fits = flag('--fits');
const [file, out] = rest;
if (!file || !out) {
  console.error('usage: node tools/page_screenshot.mjs FILE.html OUT.png [--width N] [--height N] [--dark] [--full] [--select CSS] [--fits] [--pdf OUT.pdf]');
  process.exit(2);
}
const executablePath = [process.env.TOOTHPATH_CHROMIUM, '/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome']
  .find((path) => path && existsSync(path));
const profile = mkdtempSync(join(tmpdir(), 'toothpath-page-'));
const browser = await puppeteer.launch({
  executablePath, userDataDir: profile,
  args: ['--no-sandbox', '--disable-gpu', '--enable-unsafe-swiftshader', '--disable-quic', '--no-first-run',
         '--disable-background-networking', '--disable-component-update', '--disable-sync'],
});
let status = 0;
try {
  const page = await browser.newPage();
  page.on('pageerror', (error) => { console.error(error.message); status = 1; });
  page.on('console', (message) => { if (message.type() === 'error') { console.error(message.text()); status = 1; } });
  await page.setViewport({width, height, deviceScaleFactor: width < 600 ? 2 : 1, hasTouch: width < 600, isMobile: width < 600});
  await page.emulateMediaFeatures([{name: 'prefers-color-scheme', value: dark ? 'dark' : 'light'}]);
  await page.goto(pathToFileURL(resolve(file)).href);
  await page.waitForFunction(() => !document.title.startsWith('Loading'), {timeout: 60000});
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  const wide = await page.evaluate(() => document.documentElement.scrollWidth);
  if (fits && wide > width) { console.error(`${file}: ${wide} px wide in a window of ${width}`); status = 1; }
  if (pdf) await page.pdf({path: pdf, format: 'A4', preferCSSPageSize: true, printBackground: true});
  if (select) await (await page.$(select)).screenshot({path: out});
  else await page.screenshot({path: out, fullPage: full});
} finally {
  await browser.close();
  rmSync(profile, {recursive: true, force: true});
}
process.exit(status);
