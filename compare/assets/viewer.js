// The beds of all engines, side by side, at one time. Reads the element #viewer-data (compare/viewer.py), draws into
// #viewer. Texts of a case or a dataset are only ever set as textContent.
"use strict";
(async () => {
  const holder = document.getElementById("viewer");
  const source = document.getElementById("viewer-data");
  if (!holder || !source || !window.DecompressionStream) return;
  const data = JSON.parse(source.textContent);

  const element = (name, properties = {}, ...children) => {
    const made = Object.assign(document.createElement(name), properties);
    made.append(...children);
    return made;
  };
  const say = (place, text) => { if (place.textContent !== text) place.textContent = text; }; // to lay out no more than changes
  const shown = (value) => String(Number(value.toPrecision(3))).replace("-", "−");

  // The inverse of pack() in viewer.py: Float32Array per frame.
  async function unpack({ step, gzip }, particles) {
    const squeezed = Uint8Array.from(atob(gzip), (letter) => letter.charCodeAt(0));
    const stream = new Blob([squeezed]).stream().pipeThrough(new DecompressionStream("gzip"));
    const view = new DataView(await new Response(stream).arrayBuffer());
    const steps = new Int16Array(particles); // runs over as the differences did
    const frames = [];
    for (let offset = 0; offset < view.byteLength; offset += 2 * particles) {
      const values = new Float32Array(particles);
      for (let i = 0; i < particles; i++) {
        steps[i] += view.getInt16(offset + 2 * i, true);
        values[i] = step * steps[i];
      }
      frames.push(values);
    }
    return frames;
  }

  for (const run of data.runs) {
    const particles = run.radius_m.length;
    for (const [name, packed] of Object.entries(run.channels)) run.channels[name] = await unpack(packed, particles);
  }
  const [first] = data.runs;
  const last = first.time_s.length - 1;

  // Values at a frame that need not be whole: of the bar, and of a channel of particle i.
  const between = (values, frame) => {
    const before = Math.floor(frame);
    return values[before] + (frame - before) * ((values[before + 1] ?? values[before]) - values[before]);
  };
  const at = (run, name, i, frame) => {
    const frames = run.channels[name];
    const before = Math.floor(frame);
    const value = frames[before][i];
    return frame > before ? value + (frame - before) * (frames[before + 1][i] - value) : value;
  };
  const apart = (run, i, frame, other, otherFrame) =>
    Math.hypot(at(run, "x", i, frame) - at(other, "x", i, otherFrame), at(run, "y", i, frame) - at(other, "y", i, otherFrame));

  // What particles can be coloured by: value(run, i, frame) or NaN where a run has none; in `unit`, `times` SI.
  const colourings = {
    layer: { title: "layer at the start" },
    displacement: { title: "displacement", unit: "mm", times: 1000, value: (run, i, frame) => apart(run, i, frame, run, 0) },
    speed: { title: "speed", unit: "mm/s", times: 1000, value: (run, i, frame) => at(run, "speed", i, frame) },
    spin: { title: "speed of rotation", unit: "rad/s", times: 1, signed: true, value: (run, i, frame) => at(run, "spin", i, frame) },
    angle: { title: "rotation", unit: "rad", times: 1, signed: true, value: (run, i, frame) => (run.channels.angle ? at(run, "angle", i, frame) : NaN) },
  };
  const comparable = data.runs.filter((run) => run.packing === first.packing);
  if (comparable.length > 1)
    colourings.difference = { title: `distance to the same particle in ${first.engine}`, unit: "mm", times: 1000,
      value: (run, i, frame) => (run.packing === first.packing ? apart(run, i, frame, first, frame) : NaN) };

  const GROWING = [[98, 70, 160], [59, 110, 170], [33, 155, 150], [110, 205, 95], [253, 231, 37]]; // seen on white and on black
  const SIGNED = [[33, 102, 172], [146, 197, 222], [200, 200, 200], [244, 165, 130], [178, 24, 43]];
  const SHADES = 48;
  const shade = (stops, share) => {
    const place = Math.min(Math.max(share, 0), 1) * (stops.length - 1);
    const from = Math.min(Math.floor(place), stops.length - 2);
    return `rgb(${stops[from].map((value, k) => Math.round(value + (place - from) * (stops[from + 1][k] - value)))})`;
  };
  const shades = (stops) => Array.from({ length: SHADES }, (_, k) => shade(stops, k / (SHADES - 1)));
  const palettes = { growing: shades(GROWING), signed: shades(SIGNED) };

  // Ends of the scale: 99 of 100 sizes lie within it, so that a few particles that are thrown do not flatten the rest.
  function scaleOf(colouring) {
    if (colouring.top !== undefined || !colouring.value) return;
    const sizes = [];
    for (const run of data.runs)
      for (let frame = 0; frame < run.time_s.length; frame += 5)
        for (let i = 0; i < run.radius_m.length; i++) sizes.push(Math.abs(colouring.value(run, i, frame)));
    const sorted = Float64Array.from(sizes.filter((size) => !Number.isNaN(size))).sort();
    colouring.top = sorted[Math.floor(0.99 * (sorted.length - 1))] || 1e-9;
  }

  // Force chains: the springs between discs that overlap, the thicker the more.
  const THICKNESSES = 8;
  const places = (run, name, frame) => Float32Array.from(run.radius_m, (_, i) => at(run, name, i, frame));
  const overlaps = (run, frame, visit) => {
    const [x, y] = [places(run, "x", frame), places(run, "y", frame)];
    visitOverlaps(x, y, run.radius_m, (i, j, overlap) => visit(overlap, x[i], y[i], x[j], y[j]));
  };
  let thickest_m; // overlap; 99 of 100 are less
  function measureOverlaps() {
    const found = [];
    for (const run of data.runs)
      for (let frame = 0; frame < run.time_s.length; frame += 10) overlaps(run, frame, (overlap) => found.push(overlap));
    thickest_m = Float64Array.from(found).sort()[Math.floor(0.99 * (found.length - 1))] || 1e-9;
  }

  // Controls
  const play = element("button", { type: "button", id: "viewer-play", textContent: "Play" });
  const slider = element("input", { type: "range", id: "viewer-time", min: 0, max: last, step: 1, value: 0 });
  slider.setAttribute("aria-label", "time");
  const clock = element("output", { id: "viewer-clock" });
  const choice = element("select", { id: "viewer-colour" });
  for (const [name, { title }] of Object.entries(colourings)) choice.append(element("option", { value: name, textContent: title }));
  const number = element("input", { type: "number", id: "viewer-particle", min: 0, max: first.radius_m.length - 1, placeholder: "none" });
  const forces = element("input", { type: "checkbox", id: "viewer-forces" });
  const scale = element("div", { className: "scale" });
  const beds = element("div", { className: "viewer-beds" });
  holder.append(
    element("div", { className: "controls" }, play, slider, clock,
      element("label", {}, "colour by ", choice), element("label", {}, forces, " force chains"),
      element("label", {}, "particle ", number)),
    scale, beds);

  const aspect = data.height_m / data.width_m;
  const bedsOf = data.runs.map((run) => {
    const canvas = element("canvas");
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", `the bed of ${run.engine}`);
    const dot = element("span", { className: "dot" });
    dot.style.setProperty("--engine", run.colour);
    const said = element("output", { className: "quiet said" });
    const caption = element("figcaption", {}, element("span", { className: "engine" }, dot, run.engine),
      element("span", { className: "quiet" }, ` seed ${run.seed}`));
    beds.append(element("figure", {}, caption, canvas, said));
    return { run, canvas, said, pen: canvas.getContext("2d") };
  });

  let frame = 0;
  let chosen = null; // particle
  let colours;
  const frameOf = (run) => Math.min((frame * (run.time_s.length - 1)) / last, run.time_s.length - 1);

  function readColours() {
    const style = getComputedStyle(document.documentElement);
    colours = Object.fromEntries(["ink", "bar", "line", "quiet"].map((name) => [name, style.getPropertyValue(`--${name}`).trim()]));
  }

  function colourOf(run, i, here) {
    const colouring = colourings[choice.value];
    if (!colouring.value) return data.layer_colours[run.layer[i]];
    const share = colouring.value(run, i, here) / colouring.top;
    if (Number.isNaN(share)) return colours.line;
    const place = Math.min(Math.max(colouring.signed ? (share + 1) / 2 : share, 0), 1);
    return palettes[colouring.signed ? "signed" : "growing"][Math.round(place * (SHADES - 1))];
  }

  function drawBed({ run, canvas, pen, said }) {
    const here = frameOf(run);
    const scale = canvas.width / data.width_m; // pixels per metre
    const across = (x_m) => scale * x_m;
    const down = (y_m) => canvas.height - scale * y_m;
    const circle = (i, share) => {
      pen.beginPath();
      pen.arc(across(at(run, "x", i, here)), down(at(run, "y", i, here)), share * scale * run.radius_m[i], 0, 2 * Math.PI);
    };
    pen.clearRect(0, 0, canvas.width, canvas.height);
    pen.globalAlpha = forces.checked ? 0.45 : 1;
    for (let i = 0; i < run.radius_m.length; i++) {
      pen.fillStyle = colourOf(run, i, here);
      circle(i, 0.93); // a little small, to be told apart
      pen.fill(); // one by one: a path of many circles takes longer
    }
    pen.globalAlpha = 1;
    pen.strokeStyle = colours.ink;
    if (forces.checked) {
      const lines = Array.from({ length: THICKNESSES }, () => new Path2D());
      overlaps(run, here, (overlap, x, y, other_x, other_y) => {
        const line = lines[Math.min(Math.floor((THICKNESSES * overlap) / thickest_m), THICKNESSES - 1)];
        line.moveTo(across(x), down(y));
        line.lineTo(across(other_x), down(other_y));
      });
      lines.forEach((line, number) => {
        pen.lineWidth = ((number + 0.5) / THICKNESSES) * 0.7 * scale * run.radius_m[0];
        pen.stroke(line);
      });
    }
    const { centre_x_m, width_m, length_m } = data.bar;
    pen.fillStyle = colours.bar;
    pen.fillRect(across(centre_x_m - width_m / 2), down(between(run.bar_tip_m, here) + length_m), scale * width_m, scale * length_m);
    pen.lineWidth = 2;
    pen.strokeRect(0, -2, canvas.width, canvas.height + 2);
    if (chosen !== null && chosen < run.radius_m.length) {
      circle(chosen, 1.3);
      pen.stroke();
    }
    say(said, sayParticle(run, here));
  }

  function sayParticle(run, here) {
    if (chosen === null || chosen >= run.radius_m.length) return run === first ? "Point at a particle for its values in every bed." : "";
    const parts = [`particle ${chosen}`,
      `x ${shown(100 * at(run, "x", chosen, here))}, y ${shown(100 * at(run, "y", chosen, here))} cm`];
    for (const { title, unit, times, value } of Object.values(colourings)) {
      const found = value ? value(run, chosen, here) : NaN;
      if (!Number.isNaN(found)) parts.push(`${title} ${shown(times * found)} ${unit}`);
    }
    return parts.join("; ");
  }

  function draw() {
    say(clock, `${first.time_s[Math.round(frame)].toFixed(2)} s`);
    if (slider.ariaValueText !== clock.textContent) slider.ariaValueText = clock.textContent;
    bedsOf.forEach(drawBed);
  }

  function drawScale() {
    const colouring = colourings[choice.value];
    scaleOf(colouring);
    scale.replaceChildren();
    if (forces.checked) {
      if (thickest_m === undefined) measureOverlaps();
      const thickest_mN = 1000 * data.normal_stiffness_N_m * thickest_m;
      scale.append(element("span", { textContent: `lines: stiffness × overlap, the thickest ${shown(thickest_mN)} mN and more` }));
    }
    if (!colouring.value) return;
    const strip = element("span", { className: "strip" });
    const stops = colouring.signed ? SIGNED : GROWING;
    strip.style.background = `linear-gradient(to right, ${stops.map((stop) => `rgb(${stop})`).join(", ")})`;
    const top = shown(colouring.times * colouring.top);
    scale.append(colouring.signed ? `−${top}` : "0", strip, `${top} ${colouring.unit} and more`);
    if (choice.value === "angle" && data.runs.some((run) => !run.channels.angle)) scale.append(" (grey: the engine keeps no angle)");
    if (choice.value === "difference" && comparable.length < data.runs.length) scale.append(" (grey: another packing)");
  }

  function resize() {
    for (const { canvas } of bedsOf) {
      const width = Math.max(1, Math.round(canvas.clientWidth * Math.min(window.devicePixelRatio || 1, 2)));
      canvas.width = width;
      canvas.height = Math.round(width * aspect);
    }
    draw();
  }

  // Playing: as fast as it happened
  const frames_per_ms = last / (1000 * (first.time_s[last] - first.time_s[0]));
  let before; // time of the last picture, by the clock of the pictures
  let playing = null; // the picture that is asked for; null: paused
  function tick(now) {
    frame = Math.min(last, frame + (now - (before ?? now)) * frames_per_ms);
    before = now;
    slider.value = Math.round(frame);
    draw();
    if (frame >= last) pause();
    else playing = requestAnimationFrame(tick);
  }
  function pause() {
    cancelAnimationFrame(playing);
    playing = null;
    play.textContent = "Play";
  }
  play.addEventListener("click", () => {
    if (playing !== null) return pause();
    if (frame >= last) frame = 0;
    before = undefined;
    play.textContent = "Pause";
    playing = requestAnimationFrame(tick);
  });
  slider.addEventListener("input", () => {
    pause();
    frame = Number(slider.value);
    draw();
  });
  for (const control of [choice, forces]) control.addEventListener("change", () => { drawScale(); draw(); });
  number.addEventListener("input", () => {
    chosen = number.value === "" ? null : Math.min(Math.max(Math.round(number.value), 0), first.radius_m.length - 1);
    draw();
  });
  for (const { run, canvas } of bedsOf) {
    const point = (event) => {
      const box = canvas.getBoundingClientRect();
      const x = ((event.clientX - box.left) / box.width) * data.width_m;
      const y = (1 - (event.clientY - box.top) / box.height) * data.height_m;
      const here = frameOf(run);
      const found = run.radius_m.findIndex((radius, i) => Math.hypot(at(run, "x", i, here) - x, at(run, "y", i, here) - y) <= radius);
      if (found < 0) return;
      chosen = found;
      number.value = found;
      draw();
    };
    canvas.addEventListener("pointermove", point);
    canvas.addEventListener("pointerdown", point);
  }
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { readColours(); draw(); });
  new ResizeObserver(resize).observe(beds);
  readColours();
  drawScale();
  resize();
  holder.dataset.ready = "yes";
})();
