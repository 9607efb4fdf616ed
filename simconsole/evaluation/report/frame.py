"""What every page has: its head, its style for screen and paper, and pictures that have words."""

from collections.abc import Sequence
from html import escape
from typing import Final

STYLE: Final = """
:root{color-scheme:light}
body{font:15px/1.5 system-ui,-apple-system,"Segoe UI",Roboto,"DejaVu Sans",sans-serif;color:#202124;background:#fff;
max-width:960px;margin:2rem auto;padding:0 1rem}
h1{font-size:1.5rem;margin:0 0 .2rem}h2{font-size:1.1rem;margin:2rem 0 .5rem}
p.note{color:#5f6368;margin:.2rem 0 1rem}
table{border-collapse:collapse;width:100%;font-variant-numeric:tabular-nums}
.wide{overflow-x:auto}
th,td{text-align:left;padding:.28rem .8rem .28rem 0;border-bottom:1px solid #e8eaed;vertical-align:top}
th{font-weight:600;color:#5f6368}td.n,th.n{text-align:right}
ul.tiles{display:flex;flex-wrap:wrap;gap:.8rem;padding:0;margin:1rem 0;list-style:none}
ul.tiles li{flex:1 1 8rem;border:1px solid #e8eaed;border-radius:6px;padding:.6rem .8rem}
ul.tiles b{display:block;font-size:1.25rem;font-variant-numeric:tabular-nums}
ul.tiles span{color:#5f6368;font-size:.85rem}
figure{margin:1rem 0}svg{width:100%;height:auto}figcaption{color:#5f6368;font-size:.85rem}
dl{display:grid;grid-template-columns:minmax(8rem,1fr) 3fr;gap:.2rem .8rem}dt{font-weight:600;color:#5f6368}dd{margin:0}
@page{margin:15mm}
@media print{body{max-width:none;margin:0;padding:0;font-size:10pt}h1,h2{break-after:avoid}
figure,tr,ul.tiles,dt,dd{break-inside:avoid}svg{max-height:150mm}.wide{overflow:visible}a{color:inherit}}
"""


_WIDE: Final = '<div class="wide" tabindex="0">'
"""Around a table: where it is wider than the window, it moves beneath a finger or the arrow keys, and not the page."""


def html_page(title: str, parts: Sequence[str]) -> str:
    """Return a whole page in the style of the reports; `parts` are HTML."""
    head = [
        "<!DOCTYPE html>",
        '<html lang="en"><head><meta charset="utf-8">',
        '<meta name="viewport" content="width=device-width,initial-scale=1">',
        f"<title>{escape(title)}</title><style>{STYLE}</style></head><body><main>",
    ]
    body = "\n".join(parts).replace("<table>", f"{_WIDE}<table>").replace("</table>", "</table></div>")
    return "\n".join((*head, body, "</main></body></html>", ""))


def picture(svg: str, title: str, words: str) -> str:
    """Return a figure of a page: SVG text with a name, and beneath it in words what it shows.

    Args:
        svg: as figures.py makes it.
        title: what a screen reader calls the picture.
        words: the caption; whoever does not see the picture reads there what is in it.
    """
    named = svg.replace("<svg ", f'<svg role="img" aria-label="{escape(title, quote=True)}" ', 1)
    return f"<figure>{named}<figcaption>{escape(words)}</figcaption></figure>"
