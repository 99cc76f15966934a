#include "cli/report_assets.h"

namespace sherd {

// Colours of the states after Okabe and Ito: they differ in lightness and along blue–yellow, which nearly
// everybody sees. No state is told by its colour alone: a mark and a word always stand beside it.
const char* const kReportStyle = R"css(
:root {
  --page: #eef0f3; --card: #ffffff; --sunk: #f6f7f9; --line: #d5d9e0; --text: #1b1f27; --soft: #5b6472;
  --wire: #8b95a5; --accent: #7a3ff2; --mark: #ffffff;
  --run: #00805c; --hit: #0a6ebd; --failed: #cc3d00; --skipped: #a87200; --unneeded: #7b8494;
  --shadow: 0 1px 2px rgb(20 30 50 / .10), 0 2px 8px rgb(20 30 50 / .06);
  color-scheme: light dark;
}
@media (prefers-color-scheme: dark) {
  :root {
    --page: #14171c; --card: #1f242c; --sunk: #191d24; --line: #39414d; --text: #e8ebf0; --soft: #a0a9b8;
    --wire: #7c8798; --accent: #b79cff; --mark: #14171c;
    --run: #3cc79a; --hit: #5db5f0; --failed: #ff8552; --skipped: #f0b93a; --unneeded: #98a1b0;
    --shadow: 0 1px 3px rgb(0 0 0 / .5);
  }
}
.s-run { --state: var(--run); } .s-hit { --state: var(--hit); } .s-failed { --state: var(--failed); }
.s-skipped { --state: var(--skipped); } .s-unneeded { --state: var(--unneeded); }

* { box-sizing: border-box; }
body { margin: 0; background: var(--page); color: var(--text);
  font: 14px/1.45 system-ui, "Segoe UI", "Helvetica Neue", Arial, "Liberation Sans", "DejaVu Sans", sans-serif; }
code, .mono { font-family: ui-monospace, "Cascadia Mono", Menlo, "Liberation Mono", "DejaVu Sans Mono", monospace;
  font-size: 12.5px; }
header, main, section.wide { max-width: 1900px; margin: 0 auto; padding: 0 20px; }
header { padding-top: 14px; padding-bottom: 12px; }
h1 { font-size: 21px; line-height: 1.25; margin: 0; font-weight: 650; overflow-wrap: anywhere; }
h2 { font-size: 15px; margin: 0 0 8px; font-weight: 650; }
.headline { display: flex; flex-wrap: wrap; gap: 6px 14px; align-items: baseline; }
.verdict { padding: 1px 11px 2px; border-radius: 99px; color: var(--mark); background: var(--state); font-weight: 650; }
.total { font-size: 16px; font-variant-numeric: tabular-nums; }
.command { color: var(--soft); overflow-wrap: anywhere; }
.counts { display: flex; flex-wrap: wrap; gap: 4px 18px; margin: 8px 0 0; padding: 0; list-style: none; align-items: center; }
.counts li, .word { display: inline-flex; gap: 6px; align-items: center; }
.counts li.none { color: var(--soft); opacity: .65; }
.counts b { font-variant-numeric: tabular-nums; }
.skips { color: var(--soft); margin: 6px 0 0; }
.errors { margin: 10px 0 0; padding: 0; list-style: none; }
.errors li { border: 1px solid var(--line); border-left: 5px solid var(--failed); background: var(--card); border-radius: 6px;
  padding: 6px 12px; margin-top: 6px; white-space: pre-wrap; overflow-wrap: anywhere; }
.errors button { font-weight: 650; }
svg.mark, .word svg { width: 16px; height: 16px; flex: none; color: var(--state); }

main { display: grid; grid-template-columns: minmax(0, 1fr) 400px; gap: 14px; }
.card-like { background: var(--card); border: 1px solid var(--line); border-radius: 10px; box-shadow: var(--shadow); }
#graph { position: relative; height: max(430px, calc(100vh - 150px)); }
#scroll { overflow: auto; height: 100%; border-radius: 10px; display: flex; }
#drawing { margin: auto; flex: none; display: block; }
.tools { position: absolute; right: 12px; top: 10px; display: flex; gap: 4px; }
button { font: inherit; color: inherit; background: none; border: 0; padding: 0; cursor: pointer; text-align: left; }
.tools button { background: var(--card); border: 1px solid var(--line); border-radius: 6px; min-width: 30px; padding: 2px 8px;
  text-align: center; }
.tools button:hover { border-color: var(--accent); }
:focus-visible { outline: 2px solid var(--accent); outline-offset: 2px; }

#details { height: max(430px, calc(100vh - 150px)); overflow: auto; padding: 14px 16px; overflow-wrap: anywhere; }
#details h2 { font-size: 18px; margin: 0; }
#details h3 { font-size: 12px; margin: 16px 0 5px; color: var(--soft); font-weight: 650; text-transform: uppercase;
  letter-spacing: .04em; }
#details p { margin: 4px 0; }
.facts { display: grid; grid-template-columns: auto 1fr; gap: 2px 14px; margin: 10px 0 0; }
.facts dt { color: var(--soft); } .facts dd { margin: 0; font-variant-numeric: tabular-nums; }
.note { padding: 6px 10px; border-radius: 6px; background: var(--sunk); border-left: 4px solid var(--line); margin: 5px 0;
  white-space: pre-wrap; }
.note.warning { border-left-color: var(--skipped); } .note.error { border-left-color: var(--failed); }
.soft { color: var(--soft); }
details summary { cursor: pointer; color: var(--soft); margin-top: 8px; }

table { border-collapse: collapse; width: 100%; }
th, td { text-align: left; vertical-align: top; padding: 4px 10px 4px 0; border-bottom: 1px solid var(--line); }
th { color: var(--soft); font-weight: 600; font-size: 12.5px; white-space: nowrap; }
td.number, th.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
#details table { font-size: 13px; overflow-wrap: normal; } #details td code { overflow-wrap: anywhere; }
#details tr.chosen { background: var(--sunk); } #details tr.chosen td:first-child { box-shadow: inset 3px 0 var(--accent); }
#details td:first-child { padding-left: 7px; } #details th:first-child { padding-left: 7px; }
.wide { margin-top: 16px !important; }
.wide > div { padding: 14px 16px; overflow-x: auto; }
#nodes td { padding: 5px 18px 5px 0; } #nodes th { padding-right: 18px; }
#nodes tbody tr { cursor: pointer; } #nodes tbody tr:hover, #nodes tr.chosen { background: var(--sunk); }
#nodes th button { font-weight: 600; } #nodes th button::after { content: " ↕"; opacity: .45; }
#nodes th[aria-sort=ascending] button::after { content: " ↑"; opacity: 1; }
#nodes th[aria-sort=descending] button::after { content: " ↓"; opacity: 1; }
.bar { display: inline-flex; width: 90px; height: 5px; border-radius: 3px; background: var(--sunk); vertical-align: middle;
  margin-left: 8px; overflow: hidden; }
.bar i { background: var(--state); border-radius: 3px; }
.tablehead { display: flex; justify-content: space-between; gap: 12px; align-items: baseline; }
input[type=search] { font: inherit; color: inherit; background: var(--sunk); border: 1px solid var(--line); border-radius: 6px;
  padding: 3px 9px; width: 220px; }
.pictures { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 480px), 1fr)); gap: 14px; }
figure { margin: 0; } figure.large { grid-column: 1 / -1; }
figure img { width: 100%; border-radius: 6px; border: 1px solid var(--line); display: block; }
figure button { display: block; width: 100%; cursor: zoom-in; } figure.large button { cursor: zoom-out; }
figcaption { color: var(--soft); font-size: 12.5px; margin-top: 3px; overflow-wrap: anywhere; }
footer { height: 24px; }

#drawing text { fill: var(--text); font-size: 12.5px; }
#drawing .heading { font-size: 17px; font-weight: 650; }
.box { cursor: pointer; outline: none; }
.box .card { fill: var(--card); stroke: var(--state); stroke-width: 1.6; filter: drop-shadow(0 1px 2px rgb(20 30 50 / .18)); }
.box.s-failed .card { stroke-width: 3; }
.box.s-unneeded .card, .box.s-skipped .card { stroke-dasharray: 6 4; }
.box.s-unneeded { opacity: .75; }
.box:hover .card { stroke-width: 2.6; }
.box:focus-visible .card, .box.chosen .card { stroke: var(--accent); stroke-width: 3.2; stroke-dasharray: none; }
.box .mark { color: var(--state); }
#drawing .name { font-size: 15px; font-weight: 650; }
#drawing .type { fill: var(--soft); }
#drawing .result { text-anchor: end; font-weight: 600; fill: var(--state); }
#drawing .count { text-anchor: end; fill: var(--soft); font-weight: 600; }
.track { fill: var(--line); opacity: .7; } .time { fill: var(--state); }
#drawing .port text { font-size: 11px; text-anchor: middle; fill: var(--soft); }
.port circle { fill: var(--card); stroke: var(--wire); stroke-width: 1.6; }
.port.param circle { fill: var(--wire); }
.wire { fill: none; stroke: var(--wire); stroke-width: 1.7; }
.wire:hover { stroke: var(--accent); stroke-width: 3; }
.wire.near { stroke: var(--accent); stroke-width: 2.4; }

@media (max-width: 980px) { main { grid-template-columns: minmax(0, 1fr); } #details { height: auto; } }
@media print { #graph, #scroll, #details { height: auto; overflow: visible; } .tools, input[type=search] { display: none; } }
)css";

const char* const kReportMarks =
    R"svg(<svg width="0" height="0" style="position:absolute" aria-hidden="true"><defs>
<symbol id="m-run" viewBox="0 0 18 18"><circle cx="9" cy="9" r="9" fill="currentColor"/><path d="M6.8 4.9v8.2l6.6-4.1z" fill="var(--mark)"/></symbol>
<symbol id="m-hit" viewBox="0 0 18 18"><circle cx="9" cy="9" r="9" fill="currentColor"/><path d="M4.8 9.4l3 3 5.4-6" fill="none" stroke="var(--mark)" stroke-width="2.2"/></symbol>
<symbol id="m-failed" viewBox="0 0 18 18"><rect width="18" height="18" rx="3.5" fill="currentColor"/><path d="M5.2 5.2l7.6 7.6m0-7.6l-7.6 7.6" stroke="var(--mark)" stroke-width="2.4"/></symbol>
<symbol id="m-skipped" viewBox="0 0 18 18"><path d="M9 0l9 9-9 9-9-9z" fill="currentColor"/><path d="M5.4 5.8L8.6 9l-3.2 3.2M9.4 5.8L12.6 9l-3.2 3.2" fill="none" stroke="var(--mark)" stroke-width="1.8"/></symbol>
<symbol id="m-unneeded" viewBox="0 0 18 18"><circle cx="9" cy="9" r="7.9" fill="none" stroke="currentColor" stroke-width="2" stroke-dasharray="3 2"/><path d="M5.5 9h7" stroke="currentColor" stroke-width="2"/></symbol>
</defs></svg>
)svg";

}  // namespace sherd
