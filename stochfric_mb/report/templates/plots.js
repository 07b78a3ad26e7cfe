// Figures of a page: hover shows values, a drag zooms in, a double click zooms out. Without this script they stay as drawn.
(() => {
  "use strict";
  const drawn = document.querySelectorAll("svg[data-axes]");
  const SVG = drawn[0]?.namespaceURI;
  const REACH = 24; // how near the pointer must be to a point of a curve [px]
  const tip = document.createElement("div");
  tip.className = "tip";
  tip.hidden = true;
  document.body.append(tip);

  const text = (value) => {
    const size = Math.abs(value);
    const plain = size && (size < 1e-3 || size >= 1e6) ? value.toExponential(3) : String(Number(value.toPrecision(5)));
    return plain.replace("-", "\u2212");
  };
  const inner = (value, kind) => (kind === "log" ? Math.log10(value) : value);
  const outer = (value, kind) => (kind === "log" ? 10 ** value : value);

  // round numbers from low to high
  const rounds = (low, high, count) => {
    const unit = 10 ** Math.floor(Math.log10((high - low) / count));
    const step = unit * [1, 2, 5, 10].find((m) => m * unit >= (high - low) / count);
    const first = Math.ceil(low / step - 1e-9);
    return Array.from({ length: Math.floor(high / step + 1e-9) - first + 1 }, (_, i) => (first + i) * step);
  };

  class Axes {
    constructor(group, facts) {
      Object.assign(this, facts, { group });
      const own = (e) => !e.closest(".axis");
      this.moved = [...group.querySelectorAll("[clip-path]")].filter(own).flatMap((e) => this.parts(e));
      this.curves = facts.series.map((name, i) => [name, group.querySelector(`[data-series="${i}"]`)]);
      this.view = this.box; // part of the drawing that fills the axes
    }

    // what is shifted and stretched inside a clipped element, with its coordinates as drawn
    parts(element) {
      if (element.tagName === "path") return [{ element, d: element.getAttribute("d") }];
      const uses = [...element.querySelectorAll("use")];
      if (uses.length) return uses.map((e) => ({ element: e, x: +e.getAttribute("x"), y: +e.getAttribute("y") }));
      const known = [...element.querySelectorAll("path")].map((e) => ({ element: e, d: e.getAttribute("d") }));
      const images = [...element.querySelectorAll("image")];
      return [...known, ...images.map((e) => ({ element: e, transform: e.getAttribute("transform") || "" }))];
    }

    // place in the axes of a point as drawn, and the other way round; axis 0 is x
    now(value, axis) {
      const [a, b, low, high] = [this.view[axis], this.view[axis + 2], this.box[axis], this.box[axis + 2]];
      return low + ((value - a) * (high - low)) / (b - a);
    }

    drawn(value, axis) {
      const [a, b, low, high] = [this.view[axis], this.view[axis + 2], this.box[axis], this.box[axis + 2]];
      return a + ((value - low) * (b - a)) / (high - low);
    }

    // value at a point as drawn
    value(point, axis) {
      const kind = this.scales[axis];
      const [low, high] = (axis ? this.y : this.x).map((v) => inner(v, kind));
      const [from, to] = axis ? [this.box[3], this.box[1]] : [this.box[0], this.box[2]];
      return outer(low + ((point - from) * (high - low)) / (to - from), kind);
    }

    holds(x, y) {
      return x >= this.box[0] && x <= this.box[2] && y >= this.box[1] && y <= this.box[3];
    }

    points(curve) {
      const uses = [...curve.querySelectorAll("use")];
      const dots = this.moved.filter((m) => uses.includes(m.element)).map((m) => [m.x, m.y]);
      if (dots.length) return dots;
      const path = this.moved.find((m) => m.d !== undefined && curve.contains(m.element));
      return path ? [...path.d.matchAll(/(-?[\d.]+) (-?[\d.]+)/g)].map((p) => [+p[1], +p[2]]) : [];
    }

    nearest(x, y, reach) {
      let best = null;
      for (const [name, curve] of this.curves) {
        if (!curve) continue;
        curve.points ??= this.points(curve);
        for (const [px, py] of curve.points) {
          const away = Math.hypot(this.now(px, 0) - x, this.now(py, 1) - y);
          if (away < (best ? best.away : reach)) best = { away, name, x: px, y: py };
        }
      }
      return best;
    }

    zoom(view) {
      this.view = view;
      const place = (_, x, y) => `${this.now(+x, 0).toFixed(2)} ${this.now(+y, 1).toFixed(2)}`;
      for (const m of this.moved) {
        if (m.d !== undefined) m.element.setAttribute("d", m.d.replace(/(-?[\d.]+) (-?[\d.]+)/g, place));
        else if (m.transform !== undefined) m.element.setAttribute("transform", `${this.matrix()} ${m.transform}`);
        else {
          m.element.setAttribute("x", this.now(m.x, 0));
          m.element.setAttribute("y", this.now(m.y, 1));
        }
      }
      this.ticks(view === this.box);
    }

    matrix() {
      const [sx, sy] = [0, 1].map((i) => (this.box[i + 2] - this.box[i]) / (this.view[i + 2] - this.view[i]));
      return `matrix(${sx} 0 0 ${sy} ${this.now(0, 0)} ${this.now(0, 1)})`;
    }

    // ticks of the part that is shown; those of the whole are the ones that were drawn
    ticks(whole) {
      this.group.querySelectorAll(".zoomed").forEach((e) => e.remove());
      this.group.querySelectorAll(".axis").forEach((e, i) => {
        if (this.numbers[i]) e.style.display = whole ? "" : "none";
      });
      if (whole) return;
      for (const axis of [0, 1]) {
        if (!this.numbers[axis]) continue;
        const [from, to] = axis ? [this.view[3], this.view[1]] : [this.view[0], this.view[2]];
        const [low, high] = [this.value(from, axis), this.value(to, axis)];
        const kind = this.scales[axis];
        const wide = kind === "log" && high / low > 30;
        const all = wide ? rounds(Math.log10(low), Math.log10(high), 5).map((p) => 10 ** p) : rounds(low, high, 5);
        const [a, b] = [inner(low, kind), inner(high, kind)];
        for (const at of all) {
          const share = (inner(at, kind) - a) / (b - a);
          this.tick(axis, this.box[axis ? 3 : 0] + share * (axis ? this.box[1] - this.box[3] : this.box[2] - this.box[0]), at);
        }
        this.note(axis, this.labels[axis]);
      }
    }

    tick(axis, place, value) {
      const [x0, y0, x1, y1] = this.box;
      const line = document.createElementNS(SVG, "line");
      const ends = axis ? { x1: x0, x2: x1, y1: place, y2: place } : { x1: place, x2: place, y1: y0, y2: y1 };
      for (const [name, end] of Object.entries(ends)) line.setAttribute(name, end);
      line.setAttribute("class", "zoomed");
      this.group.insertBefore(line, this.group.children[1]);
      this.write(axis ? x0 - 5 : place, axis ? place + 3 : y1 + 14, text(value), axis ? "end" : "middle");
    }

    note(axis, label) {
      const [x0, y0, x1, y1] = this.box;
      this.write(axis ? x0 + 4 : x1, axis ? y0 + 10 : y1 + 27, label, axis ? "start" : "end");
    }

    write(x, y, content, anchor) {
      const made = document.createElementNS(SVG, "text");
      made.setAttribute("x", x);
      made.setAttribute("y", y);
      made.setAttribute("text-anchor", anchor);
      made.setAttribute("class", "zoomed");
      made.textContent = content;
      this.group.append(made);
    }
  }

  const watch = (svg) => {
    const facts = JSON.parse(svg.dataset.axes);
    const known = (f) => f.scales.every((s) => s === "linear" || s === "log");
    const all = [...svg.querySelectorAll(".axes")].map((g, i) => [g, facts[i]]).filter(([, f]) => f && known(f));
    const axes = all.map(([g, f]) => new Axes(g, f));
    const place = (event) => {
      const at = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
      return { x: at.x, y: at.y, in: axes.findLast((a) => a.holds(at.x, at.y)) };
    };
    let start = null;
    const mark = document.createElementNS(SVG, "rect");
    mark.setAttribute("class", "chosen");

    const tell = (event) => {
      const at = place(event);
      if (!at.in) return void (tip.hidden = true);
      const point = at.in.nearest(at.x, at.y, REACH / svg.getScreenCTM().a);
      const from = point ?? { x: at.in.drawn(at.x, 0), y: at.in.drawn(at.y, 1) };
      const told = [0, 1].filter((i) => at.in.numbers[i]);
      const lines = told.map((i) => `${at.in.labels[i] || "xy"[i]}: ${text(at.in.value(i ? from.y : from.x, i))}`);
      tip.textContent = [...(point && point.name ? [point.name] : []), ...lines].join("\n");
      tip.classList.toggle("on-curve", Boolean(point));
      tip.hidden = !lines.length;
      const left = Math.min(event.clientX + 14, document.documentElement.clientWidth - tip.offsetWidth - 4);
      tip.style.left = `${Math.max(left, 0) + scrollX}px`;
      tip.style.top = `${event.clientY + 16 + scrollY}px`;
    };

    svg.addEventListener("pointermove", (event) => {
      tell(event);
      if (!start) return;
      const at = place(event);
      const [x0, y0, x1, y1] = start.in.box;
      const inside = (v, low, high) => Math.min(Math.max(v, low), high);
      const ends = [inside(at.x, x0, x1), inside(at.y, y0, y1)];
      const thin = [Math.abs(ends[0] - start.x) < 6, Math.abs(ends[1] - start.y) < 6];
      const [a, b] = thin[0] ? [x0, x1] : [Math.min(start.x, ends[0]), Math.max(start.x, ends[0])];
      const [c, d] = thin[1] ? [y0, y1] : [Math.min(start.y, ends[1]), Math.max(start.y, ends[1])];
      start.chosen = thin[0] && thin[1] ? null : [a, c, b, d];
      for (const [name, v] of Object.entries({ x: a, y: c, width: b - a, height: d - c })) mark.setAttribute(name, v);
      if (start.chosen) svg.append(mark);
      else mark.remove();
    });
    svg.addEventListener("pointerdown", (event) => {
      const at = place(event);
      if (event.pointerType !== "touch" && event.button === 0 && at.in) start = at;
      if (start) event.preventDefault();
    });
    addEventListener("pointerup", () => {
      mark.remove();
      if (start && start.chosen) {
        const [a, b, c, d] = start.chosen;
        const one = start.in;
        one.zoom([one.drawn(a, 0), one.drawn(b, 1), one.drawn(c, 0), one.drawn(d, 1)]);
      }
      start = null;
    });
    svg.addEventListener("pointerleave", () => (tip.hidden = true));
    svg.addEventListener("dblclick", (event) => {
      const one = place(event).in;
      if (one) one.zoom(one.box);
    });
  };

  drawn.forEach(watch);
})();
