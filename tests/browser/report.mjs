// Opens a report in Chromium, uses it as a person does, and prints as JSON what was seen.
// usage: node report.mjs ADDRESS FOLDER_FOR_SCREENSHOTS
import { chromium } from "playwright-core";

const [address, folder] = process.argv.slice(2);
const WIDTHS_PX = [1280, 400];
const PLAYS = 3; // of a second or more each, as other programs may take the processor
const browser = await chromium.launch({ executablePath: "/usr/bin/chromium", args: ["--no-sandbox"] });
const seen = { complaints: [], requests: [], wider_than_window: [] };

async function open(options) {
  const page = await browser.newPage(options);
  page.on("console", (message) => seen.complaints.push(message.text()));
  page.on("pageerror", (error) => seen.complaints.push(String(error)));
  page.on("request", (request) => seen.requests.push(request.url()));
  await page.goto(address);
  await page.waitForSelector("#viewer[data-ready]", { timeout: 20_000 });
  return page;
}

// Times from picture to picture of the page
const intervals = (count) => new Promise((resolve) => {
  const times = [];
  const tick = (now) => (times.push(now) > count ? resolve(times.slice(1).map((time, k) => time - times[k])) : requestAnimationFrame(tick));
  requestAnimationFrame(tick);
});

const picture = (page, index = 0) => page.evaluate((k) => document.querySelectorAll("#viewer canvas")[k].toDataURL(), index);

async function useViewer(page) {
  const clock = () => page.textContent("#viewer-clock");
  seen.title = await page.textContent("h1");
  seen.canvases = await page.locator("#viewer canvas").count();
  const start = await picture(page);

  await page.click("#viewer-play");
  seen.intervals_ms = [];
  for (let play = 0; play < PLAYS; play++) seen.intervals_ms.push(await page.evaluate(intervals, 60));
  seen.clock_after_playing = await clock();
  await page.click("#viewer-play");
  const paused = await clock();
  await page.waitForTimeout(300);
  seen.paused = (await clock()) === paused;
  seen.moved = (await picture(page)) !== start;

  const box = await page.locator("#viewer-time").boundingBox();
  const across = (share) => [box.x + share * box.width, box.y + box.height / 2];
  await page.mouse.move(...across(0.2));
  await page.mouse.down();
  await page.mouse.move(...across(0.6), { steps: 8 });
  seen.clock_while_dragged = await clock();
  await page.mouse.move(...across(1), { steps: 8 });
  await page.mouse.up();
  seen.clock_at_the_end = await clock();
  await page.keyboard.press("ArrowLeft");
  seen.clock_after_arrow = await clock();

  seen.draw_ms = await page.evaluate(() => {
    const slider = document.getElementById("viewer-time");
    const spent = [];
    for (let frame = 0; frame <= Number(slider.max); frame++) {
      slider.value = frame;
      const before = performance.now();
      slider.dispatchEvent(new Event("input"));
      spent.push(performance.now() - before);
    }
    return spent;
  });

  seen.colourings = {};
  for (const name of await page.locator("#viewer-colour option").evaluateAll((all) => all.map((one) => one.value))) {
    await page.selectOption("#viewer-colour", name);
    seen.colourings[name] = [await picture(page, 1), await page.textContent("#viewer .scale")];
  }
  await page.selectOption("#viewer-colour", "layer");
  const without = await picture(page);
  await page.focus("#viewer-forces");
  await page.keyboard.press("Space");
  seen.forces = { drawn: (await picture(page)) !== without, scale: await page.textContent("#viewer .scale") };
  await page.keyboard.press("Space");
  seen.forces.gone = (await picture(page)) === without;
  await page.locator("#viewer canvas").first().scrollIntoViewIfNeeded();
  const bed = await page.locator("#viewer canvas").first().boundingBox();
  await page.mouse.move(bed.x + 0.1 * bed.width, bed.y + 0.95 * bed.height);
  await page.mouse.move(bed.x + 0.3 * bed.width, bed.y + 0.85 * bed.height, { steps: 20 }); // between particles, too
  seen.said = await page.locator("#viewer .said").allTextContents();
}

// Pairs of random discs that overlap: as the page finds them, and by looking at each pair.
const overlaps = (page) => page.evaluate(() => {
  const random = () => Array.from({ length: 400 }, () => Math.random() - 0.3);
  const [x, y, radius] = [random(), random(), random().map((value) => 0.01 + 0.02 * Math.abs(value))];
  const found = [];
  visitOverlaps(x, y, radius, (i, j, overlap) => found.push([i, j, overlap]));
  const expected = [];
  for (let j = 0; j < x.length; j++)
    for (let i = 0; i < j; i++) {
      const overlap = radius[i] + radius[j] - Math.hypot(x[i] - x[j], y[i] - y[j]);
      if (overlap > 0) expected.push([i, j, overlap]);
    }
  const sorted = (pairs) => pairs.sort((a, b) => a[1] - b[1] || a[0] - b[0]);
  return [sorted(found), sorted(expected)];
});

async function useCurves(page) {
  const holder = page.locator('[data-curves="resistance"]');
  const curve = () => holder.locator("canvas").evaluate((canvas) => canvas.toDataURL());
  await holder.scrollIntoViewIfNeeded();
  const whole = await curve();
  await holder.locator('input[type="checkbox"]').nth(1).uncheck();
  await page.waitForTimeout(100);
  const without = await curve();
  seen.toggled = without !== whole;
  await holder.locator('input[type="checkbox"]').nth(1).check();
  await page.waitForTimeout(100);
  seen.toggled_back = (await curve()) === whole;
  await holder.locator(".u-over").hover();
  seen.legend = await holder.locator(".u-legend").textContent();
  await page.mouse.move(0, 0);
  await holder.getByLabel("zoom in").click();
  await page.waitForTimeout(100);
  seen.zoomed = (await curve()) !== whole;
  await holder.getByLabel("the whole range").click();
}

async function useFilter(page) {
  const shown = () => page.locator("#check-rows tr[data-outcome]:visible").count();
  seen.rows = await shown();
  await page.fill("#filter-words", "yade");
  seen.rows_with_yade = await shown();
  await page.fill("#filter-words", "no such check");
  seen.rows_with_nonsense = await shown();
  await page.fill("#filter-words", "");
  await page.selectOption("#filter-outcome", "different");
  seen.rows_different = await shown();
  await page.selectOption("#filter-outcome", "");
  seen.rows_again = await shown();
}

const page = await open({ viewport: { width: 1280, height: 900 } });
await useViewer(page);
seen.overlaps = await overlaps(page);
await useCurves(page);
await useFilter(page);
await page.emulateMedia({ media: "print" });
seen.printed = {
  stills: await page.locator("#beds .still svg:visible").count(),
  canvases: await page.locator("canvas:visible").count(),
};
await page.close();

for (const colorScheme of ["light", "dark"]) {
  for (const width of WIDTHS_PX) {
    const page = await open({ viewport: { width, height: 900 }, colorScheme });
    await page.locator("#viewer-time").fill("60");
    if (await page.evaluate(() => document.documentElement.scrollWidth > innerWidth)) seen.wider_than_window.push(width);
    await page.screenshot({ path: `${folder}/${colorScheme}-${width}.png`, fullPage: true });
    await page.close();
  }
}
await browser.close();
console.log(JSON.stringify(seen));
