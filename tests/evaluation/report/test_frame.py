from simconsole.evaluation.report.frame import html_page, picture


def test_titles_are_escaped_and_parts_stand_as_they_are() -> None:
    page = html_page("a <b> & c", ["<p>one</p>", "<p>two</p>"])
    assert "<title>a &lt;b&gt; &amp; c</title>" in page
    assert "<main>\n<p>one</p>\n<p>two</p>\n</main>" in page


def test_every_table_moves_by_the_arrow_keys_where_it_is_too_wide() -> None:
    page = html_page("t", ["<table><tr></tr></table>", "<table></table>"])
    assert page.count('<div class="wide" tabindex="0"><table>') == page.count("</table></div>") == 2


def test_a_picture_has_a_name_and_words_that_cannot_break_out() -> None:
    shown = picture('<svg width="1"><svg x="2"></svg></svg>', 'speed "km/h"', "from 0 < 10")
    assert shown.startswith('<figure><svg role="img" aria-label="speed &quot;km/h&quot;" width="1"><svg x="2">')
    assert shown.endswith("<figcaption>from 0 &lt; 10</figcaption></figure>")
