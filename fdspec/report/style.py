"""How the report looks: on a screen of any width, and on A4 with page numbers."""

from typing import Final

STYLE: Final = """
:root { color-scheme: light; }
body { font: 16px/1.5 system-ui, "Segoe UI", "DejaVu Sans", sans-serif; color: #1a1a1a; background: #fff;
  margin: 0 auto; max-width: 62rem; padding: 1rem; }
header { border-bottom: 2px solid #0072b2; margin-bottom: 1rem; }
header p { margin: .1rem 0 .6rem; color: #444; }
h1 { font-size: 1.6rem; line-height: 1.25; margin: .4rem 0; }
h2 { font-size: 1.2rem; margin: 2rem 0 .5rem; }
dl { display: grid; grid-template-columns: 10rem 1fr; gap: .35rem 1rem; }
dt { font-weight: 600; } dd { margin: 0; }
.answer { font-size: 1.15rem; border-left: .4rem solid #0072b2; padding: .6rem 1rem; background: #f2f7fb; }
figure { margin: 1rem 0; }
img { display: block; width: 100%; max-width: 62rem; height: auto; }
figcaption, caption { color: #444; }
.wide { overflow-x: auto; } .wide:focus { outline: 3px solid #0072b2; }
.wide img { min-width: 36rem; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; font-size: .92rem; }
caption { text-align: left; padding-bottom: .4rem; }
th, td { padding: .2rem .7rem .2rem 0; text-align: right; border-bottom: 1px solid #ddd;
  vertical-align: top; }
thead th { vertical-align: bottom; border-bottom: 1px solid #767676; }
td.words, th.words, th:first-child { text-align: left; }
.inputs { display: block; columns: 2 20rem; column-gap: 3rem; margin: 0; }
.inputs div { display: flex; justify-content: space-between; gap: 1rem; border-bottom: 1px solid #ddd;
  padding: .2rem 0; break-inside: avoid; }
.inputs dt { font-weight: 400; color: #444; } .inputs dd { text-align: right; font-weight: 600; }
footer { margin-top: 2rem; border-top: 1px solid #ccc; color: #444; font-size: .9rem;
  overflow-wrap: anywhere; }
@media (max-width: 40rem) {
  dl { grid-template-columns: 1fr; gap: 0; } dd { margin-bottom: .6rem; }
  .answer { font-size: 1.05rem; }
  .inputs dd { margin: 0; }
}
@media print {
  @page {
    size: A4; margin: 18mm 16mm 20mm;
    @bottom-left { content: @foot@; font: 8pt system-ui, "DejaVu Sans", sans-serif; color: #444; }
    @bottom-right { content: "Page " counter(page) " of " counter(pages);
      font: 8pt system-ui, "DejaVu Sans", sans-serif; color: #444; }
  }
  body { font-size: 10pt; max-width: none; padding: 0; print-color-adjust: exact;
    -webkit-print-color-adjust: exact; }
  h1 { font-size: 17pt; } h2 { font-size: 12.5pt; margin-top: 6mm; break-after: avoid; }
  .answer { font-size: 11pt; break-inside: avoid; }
  .wide { overflow: visible; break-inside: avoid; } .wide img { min-width: 0; }
  img { max-height: 235mm; object-fit: contain; object-position: left top; }
  figure, tr, dl > div, li { break-inside: avoid; }
  figcaption { break-before: avoid; }
  thead { display: table-header-group; }
  table { width: 100%; font-size: 8.5pt; }
  th, td { padding: .6mm 2mm .6mm 0; }
  .inputs { columns: 2; column-gap: 10mm; }
  footer { font-size: 8pt; }
  details { display: none; }
}
"""
