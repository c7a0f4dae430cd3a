# SPDX-License-Identifier: GPL-3.0-or-later
"""What mkdocs does beside its settings: links to files of the repository lead to copies in the site."""

from __future__ import annotations

import posixpath
import re
from pathlib import Path

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.exceptions import PluginError
from mkdocs.structure.files import File, Files, InclusionLevel
from mkdocs.structure.pages import Page

ROOT = Path(__file__).resolve().parent.parent
#: where copies stand in the site
COPIES = "repository"
#: the end of a link's text, and its target, where that lies above the page's folder
_LINK = re.compile(r"(\]\()((?:\.\./)+[^)#\s]+)(?=[)#])")


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add copies of what pages link to outside `docs`. Raises PluginError where there is no such file."""
    for page in files.documentation_pages():
        for link in _LINK.finditer(page.content_string):
            target = _target(page, link)
            if target.startswith("docs/") or files.get_file_from_path(f"{COPIES}/{target}"):
                continue
            if not (ROOT / target).is_file():
                raise PluginError(f"docs/{page.src_uri} links to {link[2]}: the repository has no {target}")
            files.append(
                File.generated(
                    config,
                    f"{COPIES}/{target}",
                    abs_src_path=str(ROOT / target),
                    inclusion=InclusionLevel.NOT_IN_NAV,
                )
            )
    return files


def on_page_markdown(markdown: str, page: Page, config: MkDocsConfig, files: Files) -> str:
    """Turn links that leave `docs` into links to the copies."""

    def led_to_the_copy(link: re.Match[str]) -> str:
        target = _target(page.file, link)
        if target.startswith("docs/"):
            return link[0]
        return link[1] + posixpath.relpath(f"{COPIES}/{target}", posixpath.dirname(page.file.src_uri) or ".")

    return _LINK.sub(led_to_the_copy, markdown)


def _target(page: File, link: re.Match[str]) -> str:
    """Path of a link's target in the repository."""
    return posixpath.normpath(posixpath.join("docs", posixpath.dirname(page.src_uri), link[2]))
