"""The style of a study's report: light and dark, from a phone's width up."""

STYLE = """
:root { color-scheme: light dark; --paper: #fbfaf7; --ink: #23262b; --faint: #6a6f78; --line: #d9d6cd;
  --yes: #79c39a; --no: #efe4dc; --part: #e9c46a; }
@media (prefers-color-scheme: dark) { :root { --paper: #16181c; --ink: #e7e6e2; --faint: #9aa0aa; --line: #363a42;
  --yes: #2d7a55; --no: #33292a; --part: #8a6d1f; } }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 72rem; padding: 1rem; background: var(--paper); color: var(--ink);
  font: 15px/1.5 system-ui, sans-serif; }
h1 { font-size: 1.5rem; margin: .5rem 0; } h2 { font-size: 1.15rem; margin: 2rem 0 .5rem; }
p { margin: .4rem 0; max-width: 60rem; } .faint { color: var(--faint); }
.wide { overflow-x: auto; margin: .5rem 0 1rem; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
caption { text-align: left; color: var(--faint); padding: .25rem 0; }
th, td { padding: .25rem .6rem; text-align: right; border: 1px solid var(--line); white-space: nowrap; }
th { font-weight: 600; } th:first-child, td.text { text-align: left; }
td small { display: block; color: var(--faint); }
td.share { background: color-mix(in oklab, var(--yes) var(--share), var(--no)); min-width: 3.6rem; }
td.share small { color: inherit; opacity: .75; }
ul.counts { display: flex; flex-wrap: wrap; gap: .5rem; list-style: none; padding: 0; margin: 1rem 0; }
ul.counts li { border: 1px solid var(--line); border-radius: .5rem; padding: .4rem .8rem; }
ul.counts b { display: block; font-size: 1.3rem; }
details { border-top: 1px solid var(--line); padding: .4rem 0; } summary { cursor: pointer; }
code { background: var(--no); padding: .1rem .3rem; border-radius: .25rem; overflow-wrap: anywhere; }
"""
