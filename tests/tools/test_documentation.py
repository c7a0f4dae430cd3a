# SPDX-License-Identifier: GPL-3.0-or-later
"""Documents name files that are there, and their pictures are small."""

import re

import pytest

from tools.project import ROOT

DOCUMENTS = sorted([*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md")])
#: bytes
LARGEST = {".jpg": 200_000, ".png": 200_000, ".svg": 200_000, ".webp": 1_500_000}
PICTURES = sorted(path for path in (ROOT / "docs").rglob("*") if path.suffix in LARGEST)


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: str(path.relative_to(ROOT)))
def test_links_lead_somewhere(document):
    text = re.sub(r"```.*?```", "", document.read_text(encoding="utf-8"), flags=re.DOTALL)
    targets = re.findall(r"\]\(([^)\s#]+)[^)]*\)", text)
    local = [target for target in targets if "://" not in target]
    assert [target for target in local if not (document.parent / target).exists()] == []


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: str(path.relative_to(ROOT)))
def test_pictures_are_described(document):
    described = re.findall(r"!\[([^]]*)\]\(", document.read_text(encoding="utf-8"))
    assert [text for text in described if len(text.split()) < 2] == []


def test_pictures_are_small_and_shown():
    assert PICTURES
    assert [path.name for path in PICTURES if path.stat().st_size > LARGEST[path.suffix]] == []
    shown = "".join(path.read_text(encoding="utf-8") for path in DOCUMENTS)
    assert [path.name for path in PICTURES if path.name not in shown] == []


@pytest.mark.parametrize("script", [".ci/run", ".github/workflows/ci.yml"])
def test_no_document_is_written_before_tests_compare_it(script):
    """With `make docs` before them, those that find a document out of date would never fail."""
    text = (ROOT / script).read_text(encoding="utf-8")
    before, found, _ = text.partition("make test\n")
    assert found
    assert re.findall(r"make (?:docs|papers|guide|bench)$", before, flags=re.MULTILINE) == []
