// node browse.mjs URL STEPS.json FOLDER: open a page in headless Chromium, do the steps, tell what happened as JSON.
// A step is one of {shot: file}, {slider: name, value}, {click: selector}, {key: name, on: selector}, {run: script},
// {download: selector, file}, {wait: script}, {choose: selector, value}, {drag: script, by | to, shift}, {tap: script, times},
// {touch: script}, {open: path}, {page: file}, {size: [width, height]}, {axe: context}, {media: features}, {cpu: true}, {frame: script, until}. Scripts of drags and taps give places
// in CSS pixels, those of touches frames of places of fingers. Printed: results of the runs, console messages, requests.
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { chromium } from 'playwright-core';

const [url, steps, folder] = process.argv.slice(2);
const quiet = ['--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync', '--autoplay-policy=no-user-gesture-required'];
const browser = await chromium.launch({
  executablePath: process.env.TOONGEO_CHROMIUM ?? '/usr/bin/chromium',
  args: ['--no-sandbox', '--disable-quic', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', ...quiet],
});
const context = await browser.newContext({ viewport: { width: 900, height: 620 }, acceptDownloads: true, reducedMotion: 'reduce' });
const page = await context.newPage();
const report = { console: [], requests: [], results: [] };
page.on('console', (message) => report.console.push(`${message.type()}: ${message.text()}`));
page.on('pageerror', (error) => report.console.push(`error: ${error.message}`));
page.on('request', (request) => report.requests.push(request.url().slice(0, 200)));

// Two frames: one that draws, and one that shows what was drawn.
const settle = () => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));

async function act(step) {
  if (step.shot) {
    await settle();
    await page.locator('#view').screenshot({ path: join(folder, step.shot), animations: 'disabled' });
  } else if (step.slider) {
    await page.evaluate(([name, value]) => {
      const input = document.querySelector(`input[name="${CSS.escape(name)}"]`);
      input.closest('details').open = true;
      input.value = value;
      input.dispatchEvent(new Event('input', { bubbles: true }));
    }, [step.slider, step.value]);
  } else if (step.click) {
    await page.locator(step.click).click();
  } else if (step.key) {
    await page.locator(step.on).press(step.key);
  } else if (step.download) {
    const [download] = await Promise.all([page.waitForEvent('download'), page.locator(step.download).click()]);
    await download.saveAs(join(folder, step.file));
    report.results.push(download.suggestedFilename());
  } else if (step.choose) {
    await page.locator(step.choose).selectOption(step.value);
  } else if (step.drag) {
    const [x, y] = await page.evaluate(step.drag);
    const [u, v] = step.to ? await page.evaluate(step.to) : [x + step.by[0], y + step.by[1]];
    if (step.shift) await page.keyboard.down('Shift');
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(u, v, { steps: 4 });
    await page.mouse.up();
    if (step.shift) await page.keyboard.up('Shift');
  } else if (step.tap) {
    const [x, y] = await page.evaluate(step.tap);
    await page.mouse.click(x, y, { clickCount: step.times ?? 1 });
  } else if (step.touch) {
    const session = await context.newCDPSession(page);
    const frames = await page.evaluate(step.touch);
    for (const [k, fingers] of [...frames, []].entries()) {
      const type = k === 0 ? 'touchStart' : k === frames.length ? 'touchEnd' : 'touchMove';
      await session.send('Input.dispatchTouchEvent', { type, touchPoints: fingers.map(([x, y], id) => ({ x, y, id })) });
    }
  } else if (step.open) {
    await page.goto(new URL(step.open, url).href);
  } else if (step.page) {
    await settle();
    await page.screenshot({ path: join(folder, step.page), animations: 'disabled' });
  } else if (step.size) {
    await page.setViewportSize({ width: step.size[0], height: step.size[1] });
  } else if (step.axe) {
    await page.evaluate(readFileSync(new URL('node_modules/axe-core/axe.min.js', import.meta.url), 'utf8'));
    const { violations } = await page.evaluate(`axe.run(${step.axe})`);
    report.results.push(violations.map(({ id, nodes }) => [id, nodes.map(({ html, failureSummary }) => `${html.slice(0, 200)} ${failureSummary}`)]));
  } else if (step.media) {
    await page.emulateMedia(step.media);
  } else if (step.frame) {
    // In the first frame of the page, until it gives a value if there is one to wait for.
    const inner = async () => page.frames()[1]?.evaluate(step.frame).catch(() => undefined);
    if ('until' in step) while ((await inner()) !== step.until) await page.waitForTimeout(30);
    else report.results.push((await inner()) ?? null);
  } else if (step.cpu) {
    const now = await cpuSeconds();
    report.results.push(Object.fromEntries(Object.entries(now).map(([type, spent]) => [type, spent - (before[type] ?? 0)])));
  } else if (step.wait) {
    // Not waitForFunction, which evaluates in the page, whose policy forbids it.
    while (!(await page.evaluate(step.wait))) await page.waitForTimeout(30);
  } else {
    report.results.push(await page.evaluate(step.run));
  }
}

// CPU seconds of each kind of process, which do not depend on how busy the computer is.
const cdp = await browser.newBrowserCDPSession();
async function cpuSeconds() {
  const { processInfo } = await cdp.send('SystemInfo.getProcessInfo');
  return Object.fromEntries(processInfo.map(({ type, cpuTime }) => [type, cpuTime]));
}
const before = await cpuSeconds();

try {
  await page.goto(url);
  for (const step of JSON.parse(readFileSync(steps, 'utf8'))) await act(step);
} finally {
  await browser.close();
}
console.log(JSON.stringify(report));
