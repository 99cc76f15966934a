#include "cli/report_assets.h"

namespace sherd {

// Texts only ever enter the page as text, never as HTML.
const char* const kReportScript = R"js(
"use strict";
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const details = document.getElementById("details"), drawing = document.getElementById("drawing");
  const scroll = document.getElementById("scroll"), svgSpace = "http://www.w3.org/2000/svg";

  function make(tag, content, style) {
    const element = document.createElement(tag);
    if (style) element.className = style;
    for (const part of [content].flat()) if (part !== undefined && part !== "") element.append(part);
    return element;
  }
  function word(state) {
    const {name, style} = data.states[state], mark = document.createElementNS(svgSpace, "svg");
    const use = document.createElementNS(svgSpace, "use");
    use.setAttribute("href", "#m-" + style);
    mark.append(use);
    return make("span", [mark, name], "word s-" + style);
  }
  function section(title, ...parts) { details.append(make("h3", title), ...parts); }
  function table(headings, rows) {
    const head = make("tr", headings.map(heading => make("th", heading)));
    return make("table", [make("thead", head), make("tbody", rows)]);
  }
  function cells(values) { return make("tr", values.map(value => make("td", value))); }
  function facts(pairs) {
    const list = make("dl", "", "facts");
    for (const [name, value] of pairs) if (value) list.append(make("dt", name), make("dd", value));
    return list;
  }
  function jump(group, text) {
    const button = make("button", text);
    button.dataset.group = group;
    button.style.color = "var(--accent)";
    return button;
  }

  function showParams(params) {
    const row = p => {
      const line = cells([make("code", p.name), make("code", p.wired ? "wired" : p.value),
                          make("code", p.fallback), p.unit]);
      line.title = p.help;
      return line;
    };
    const headings = ["parameter", "value", "default", "unit"];
    const changed = params.filter(p => p.set || p.wired), others = params.filter(p => !p.set && !p.wired);
    if (changed.length) section("Parameters that differ from their defaults", table(headings, changed.map(row)));
    if (!others.length) return;
    const rest = make("details", [make("summary", others.length + " at their defaults"), table(headings, others.map(row))]);
    rest.open = !changed.length;
    if (changed.length) details.append(rest); else section("Parameters", rest);
  }
  function showPorts(number, group) {
    const rows = [];
    for (const port of group.inputs) {
      const from = data.wires.filter(w => w.to === number && w.input === port.name);
      rows.push(cells(["in", make("code", port.name), port.type,
        from.length ? from.flatMap((w, i) => [i ? ", " : "", jump(w.from, data.groups[w.from].name + "." + w.output)]) : make("span", "not wired", "soft")]));
      rows[rows.length - 1].title = port.help;
    }
    for (const port of group.outputs) {
      const to = data.wires.filter(w => w.from === number && w.output === port.name);
      rows.push(cells(["out", make("code", port.name), port.type,
        to.length ? to.flatMap((w, i) => [i ? ", " : "", jump(w.to, data.groups[w.to].name + "." + w.input)]) : make("span", "not wired", "soft")]));
      rows[rows.length - 1].title = port.help;
    }
    if (rows.length) section("Ports", table(["", "port", "type", "wired to"], rows));
  }
  function showRuns(number, group, chosen) {
    const all = group.runs.length + group.leftOut;
    if (all < 2) return;
    section(all + " frames and wedges", table(["", "state", "time", "why"], group.runs.map((run, i) => {
      const open = make("button", run.context || "all");
      open.dataset.group = number;
      open.dataset.run = i;
      open.style.color = "var(--accent)";
      const line = cells([open, word(run.state), run.time, run.why]);
      if (i === chosen) line.className = "chosen";
      return line;
    })));
    if (group.leftOut) details.append(make("p", group.leftOut + " more are not shown: too much for one page", "soft"));
  }

  /// Scrolls the drawing, and not the page, until the box is in sight.
  function reveal(box) {
    const inner = box.getBoundingClientRect(), outer = scroll.getBoundingClientRect(), room = 30;
    if (inner.left < outer.left || inner.right > outer.right)
      scroll.scrollLeft += (inner.left + inner.right - outer.left - outer.right) / 2;
    if (inner.bottom > outer.bottom) scroll.scrollTop += inner.bottom - outer.bottom + room;
    if (inner.top < outer.top) scroll.scrollTop += inner.top - outer.top - room;
  }
  function show(number, chosen, element) {
    const group = data.groups[number];
    if (!group) return;
    if (chosen === undefined) {
      // What matters most: the worst state, and of several the slowest.
      chosen = group.runs.reduce((best, run, i) => {
        const other = group.runs[best];
        return run.state < other.state || (run.state === other.state && run.ms > other.ms) ? i : best;
      }, 0);
    }
    const run = group.runs[chosen];
    details.replaceChildren();
    details.append(make("h2", group.name), make("p", [make("code", group.type), group.graph ? make("span", " in " + group.graph, "soft") : ""]),
      make("p", group.help, "soft"));
    const several = group.runs.length + group.leftOut > 1;
    details.append(facts([["state", several ? make("span", [word(run.state), run.context ? " in " + run.context : ""]) : word(run.state)],
      ["why", run.why], ["depends on", several ? "" : run.context], ["time", several && run.time ? run.time + " (of " + group.time + " in all)" : run.time],
      ["threads", run.threads ? String(run.threads) : ""], ["in memory", run.memory], ["in the cache", run.cache]]));
    if (run.error) section("Error", make("div", run.error, "note error"));
    if (run.messages.length) section("Messages", ...run.messages.map(line => make("div", line, line.startsWith("warning: ") ? "note warning" : "note")));
    showParams(run.params || group.runs[0].params);
    if (run.written.length) section("Files written", ...run.written.map(file => make("p", make("code", file))));
    showRuns(number, group, chosen);
    showPorts(number, group);
    details.scrollTop = 0;
    for (const old of document.querySelectorAll(".chosen")) if (!details.contains(old)) old.classList.remove("chosen");
    for (const old of drawing.querySelectorAll(".wire.near")) old.classList.remove("near");
    const box = boxes.get(number), row = rows.get(number);
    if (box) box.classList.add("chosen");
    if (row) row.classList.add("chosen");
    for (const wire of drawing.querySelectorAll(`.wire[data-from="${number}"], .wire[data-to="${number}"]`)) wire.classList.add("near");
    if (box && !drawing.contains(element)) reveal(box);
  }

  const boxes = new Map(), rows = new Map();
  for (const box of drawing.querySelectorAll(".box")) boxes.set(Number(box.dataset.group), box);
  for (const row of document.querySelectorAll("#nodes tbody tr")) rows.set(Number(row.dataset.group), row);

  function choose(event) {
    const element = event.target.closest && event.target.closest("[data-group]");
    if (!element) return false;
    show(Number(element.dataset.group), element.dataset.run === undefined ? undefined : Number(element.dataset.run), element);
    return true;
  }
  document.addEventListener("click", choose);
  document.addEventListener("keydown", event => {
    if ((event.key === "Enter" || event.key === " ") && event.target.tagName !== "BUTTON" && choose(event)) event.preventDefault();
  });

  // The table.
  const body = document.querySelector("#nodes tbody");
  for (const heading of document.querySelectorAll("#nodes th")) {
    const button = heading.querySelector("button");
    if (!button) continue;
    button.addEventListener("click", () => {
      const isNumber = heading.classList.contains("number"), column = heading.cellIndex;
      const next = heading.getAttribute("aria-sort") === (isNumber ? "descending" : "ascending") ? -1 : 1;
      const sign = isNumber ? -next : next;
      const key = row => row.cells[column].dataset.key ?? row.cells[column].textContent;
      const lines = [...body.rows].sort((a, b) => sign * (isNumber ? key(a) - key(b) : key(a) < key(b) ? -1 : key(a) > key(b) ? 1 : 0)
        || a.dataset.group - b.dataset.group);
      body.append(...lines);
      for (const other of document.querySelectorAll("#nodes th[aria-sort]")) other.removeAttribute("aria-sort");
      heading.setAttribute("aria-sort", sign > 0 ? "ascending" : "descending");
    });
  }
  document.getElementById("filter").addEventListener("input", event => {
    const wanted = event.target.value.trim().toLowerCase();
    for (const [number, row] of rows) {
      const group = data.groups[number];
      row.hidden = !(group.name + " " + group.type + " " + group.state).toLowerCase().includes(wanted);
    }
  });
  for (const button of document.querySelectorAll("figure button"))
    button.addEventListener("click", () => button.closest("figure").classList.toggle("large"));

  // Zoom.
  const width = drawing.viewBox.baseVal.width, height = drawing.viewBox.baseVal.height;
  let zoom = 1;
  function setZoom(wanted) {
    const middle = (scroll.scrollTop + scroll.clientHeight / 2) / zoom, centre = (scroll.scrollLeft + scroll.clientWidth / 2) / zoom;
    zoom = Math.min(3, Math.max(0.005, wanted));
    drawing.setAttribute("width", width * zoom);
    drawing.setAttribute("height", height * zoom);
    scroll.scrollTop = middle * zoom - scroll.clientHeight / 2;
    scroll.scrollLeft = centre * zoom - scroll.clientWidth / 2;
  }
  const whole = () => Math.min(scroll.clientWidth / width, scroll.clientHeight / height);
  document.getElementById("closer").addEventListener("click", () => setZoom(zoom * 1.25));
  document.getElementById("further").addEventListener("click", () => setZoom(zoom / 1.25));
  document.getElementById("whole").addEventListener("click", () => setZoom(Math.min(1.5, whole())));
  scroll.addEventListener("wheel", event => {
    if (!event.ctrlKey) return;
    event.preventDefault();
    setZoom(zoom * Math.exp(-event.deltaY / 400));
  }, {passive: false});
  setZoom(Math.min(1, Math.max(0.85, whole())));
  scroll.scrollTop = 0;

  // First what failed, else what took longest.
  if (data.groups.length) {
    const total = group => group.runs.reduce((sum, run) => sum + run.ms, 0), failed = group => group.runs.some(run => run.state === 0);
    let first = 0;
    data.groups.forEach((group, i) => {
      const best = data.groups[first];
      if (failed(group) && !failed(best) || failed(group) === failed(best) && total(group) > total(best)) first = i;
    });
    show(first);
  }
})();
)js";

}  // namespace sherd
