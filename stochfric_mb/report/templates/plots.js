// Figures of a page: hover shows values, a drag zooms in, a double click zooms out. Without this script they stay as drawn.
// matplotlib drew them; D3 has the scales, the ticks, the search for the nearest point and the drag.
(() => {
  "use strict";
  const REACH = 24; // how near the pointer must be to a point of a curve [px]
  const THIN = 6; // a drag that is thinner than this zooms along the other axis alone [pt]
  const SCALES = { linear: d3.scaleLinear, log: d3.scaleLog };
  const COORDINATES = /(-?[\d.]+) (-?[\d.]+)/g;
  const text = d3.format(".5~g");
  const tip = d3.select("body").append("div").attr("class", "tip").property("hidden", true);

  class Axes {
    constructor(group, facts) {
      Object.assign(this, facts, { group: d3.select(group) });
      const [x0, y0, x1, y1] = this.box;
      this.whole = [SCALES[this.scales[0]](this.x, [x0, x1]), SCALES[this.scales[1]](this.y, [y1, y0])];
      this.shown = this.whole;
      const own = [...group.querySelectorAll("[clip-path]")].filter((e) => !e.closest(".axis"));
      const inner = (e) => (e.matches("path, image") ? e : [...e.querySelectorAll("use, path, image")]);
      this.parts = d3.selectAll(own.flatMap(inner));
      this.parts.datum(function () {
        const [d, x, y, transform] = ["d", "x", "y", "transform"].map((name) => this.getAttribute(name)); // as drawn
        return { d, place: [+x, +y], transform: transform ?? "" };
      });
      this.brush = d3.brush().touchable(false).extent([[x0, y0], [x1, y1]]).handleSize(0)
        .on("brush", (event) => this.snap(event)).on("end", (event) => this.chosen(event));
      this.overlay = this.group.append("g").attr("class", "brush").call(this.brush);
    }

    // place in the axes of a point as drawn
    now(point) {
      return point.map((p, axis) => this.shown[axis](this.whole[axis].invert(p)));
    }

    // named points of the curves as drawn, in a tree of their places now
    points() {
      return this.series.flatMap((name, i) => {
        const curve = this.group.select(`[data-series="${i}"]`).node();
        const mine = this.parts.filter((_, k, all) => curve?.contains(all[k]));
        const dots = mine.filter("use").data().map((as) => as.place);
        const path = mine.filter("path").data()[0]?.d ?? "";
        const places = dots.length ? dots : [...path.matchAll(COORDINATES)].map((p) => [+p[1], +p[2]]);
        return places.map((drawn) => ({ name, drawn }));
      });
    }

    nearest(place, reach) {
      this.known ??= this.points();
      this.tree ??= d3.quadtree(this.known.map((p) => ({ ...p, now: this.now(p.drawn) })), (p) => p.now[0], (p) => p.now[1]);
      return this.tree.find(...place, reach);
    }

    // lines of the hint at a place, and whether a curve is near
    hint(place, reach) {
      const point = this.nearest(place, reach);
      const at = point ? point.now : place;
      const values = [0, 1].filter((i) => this.numbers[i])
        .map((i) => `${this.labels[i] || "xy"[i]}: ${text(this.shown[i].invert(at[i]))}`);
      return { lines: [...(point?.name ? [point.name] : []), ...values], near: Boolean(point) };
    }

    wide([[a, c], [b, d]]) {
      const [x0, y0, x1, y1] = this.box;
      return [b - a < THIN ? [x0, x1] : [a, b], d - c < THIN ? [y0, y1] : [c, d]];
    }

    snap({ sourceEvent, selection }) {
      if (!sourceEvent || !selection) return;
      const [[a, b], [c, d]] = this.wide(selection);
      this.overlay.call(this.brush.move, [[a, c], [b, d]]);
    }

    chosen({ sourceEvent, selection }) {
      if (!sourceEvent || !selection) return;
      this.overlay.call(this.brush.clear);
      const [x, [low, high]] = this.wide(selection);
      this.zoom([x, [high, low]].map((ends, i) => this.shown[i].copy().domain(ends.map(this.shown[i].invert))));
    }

    zoom(scales) {
      this.shown = scales;
      this.tree = null;
      const [[a, b], [c, d]] = [this.now([0, 0]), this.now([1, 1])];
      const moved = (_, x, y) => this.now([+x, +y]).map((p) => p.toFixed(2)).join(" ");
      this.parts.filter("path").attr("d", (as) => as.d.replace(COORDINATES, moved));
      this.parts.filter("use").attr("x", (as) => this.now(as.place)[0]).attr("y", (as) => this.now(as.place)[1]);
      this.parts.filter("image").attr("transform", (as) => `matrix(${c - a} 0 0 ${d - b} ${a} ${b}) ${as.transform}`);
      this.ticks();
    }

    // ticks of the part that is shown; those of the whole are the ones that were drawn
    ticks() {
      const whole = this.shown === this.whole;
      const [x0, y0, x1, y1] = this.box;
      this.group.selectAll(".zoomed").remove();
      this.group.selectAll(".axis").style("display", (_, i) => (this.numbers[i] && !whole ? "none" : null));
      if (whole) return;
      const made = [d3.axisBottom(this.shown[0]).tickSize(y0 - y1), d3.axisLeft(this.shown[1]).tickSize(x0 - x1)];
      const places = [[0, y1, x1, 27, "end"], [x0, 0, 4, y0 + 10, "start"]];
      for (const axis of [0, 1].filter((i) => this.numbers[i])) {
        const [left, top, x, y, anchor] = places[axis];
        const drawn = this.group.insert("g", () => this.group.node().children[1]).attr("class", "zoomed");
        drawn.attr("transform", `translate(${left} ${top})`);
        drawn.call(made[axis].ticks(5, ".5~g").tickPadding(7)).select(".domain").remove();
        drawn.append("text").attr("x", x).attr("y", y).attr("text-anchor", anchor).text(this.labels[axis]);
      }
    }
  }

  d3.selectAll("svg[data-axes]").each(function () {
    const facts = JSON.parse(this.dataset.axes);
    const groups = [...this.querySelectorAll(".axes")].map((g, i) => [g, facts[i]]);
    const axes = groups.filter(([, f]) => f?.scales.every((s) => s in SCALES)).map(([g, f]) => new Axes(g, f));
    const under = (x, y) => axes.findLast(({ box }) => x >= box[0] && x <= box[2] && y >= box[1] && y <= box[3]);
    d3.select(this)
      .on("pointermove", (event) => {
        const place = d3.pointer(event, this);
        const { lines, near } = under(...place)?.hint(place, REACH / this.getScreenCTM().a) ?? { lines: [] };
        tip.text(lines.join("\n")).classed("on-curve", near).property("hidden", !lines.length);
        const left = Math.min(event.clientX + 14, document.documentElement.clientWidth - tip.node().offsetWidth - 4);
        tip.style("left", `${Math.max(left, 0) + scrollX}px`).style("top", `${event.clientY + 16 + scrollY}px`);
      })
      .on("pointerleave", () => tip.property("hidden", true))
      .on("dblclick", (event) => {
        const one = under(...d3.pointer(event, this));
        if (one) one.zoom(one.whole);
      });
  });
})();
