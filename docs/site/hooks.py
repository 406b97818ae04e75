"""Hooks of MkDocs for `mkdocs.yml`: the site has the pages of docs, packs and labs, and the generated reference."""

from __future__ import annotations

import re
from functools import cache
from typing import TYPE_CHECKING, Any

from reference import generated_pages, plugin_anchors, with_options_link, with_plugin_links
from site_pages import (
    ROOT,
    generated_nav,
    github_anchor,
    in_python_markdown,
    repository_pages,
    repository_pictures,
    with_site_links,
)

if TYPE_CHECKING:
    from mkdocs.config.defaults import MkDocsConfig
    from mkdocs.structure.files import Files
    from mkdocs.structure.pages import Page

_pages = cache(generated_pages)
_anchors = cache(plugin_anchors)
_INLINE_CODE = re.compile(r"<code>[^<]*</code>")
_OPTION = re.compile(r"(?<![\w-])--?[a-zA-Z][\w-]*")


def on_config(config: MkDocsConfig) -> MkDocsConfig:
    """Replace each entry of the navigation that names a folder by the generated pages in it."""
    _pages.cache_clear()
    _anchors.cache_clear()
    titles = {path: title for path, (title, _) in _pages().items()}
    config.nav = _filled(config.nav, titles)
    config.mdx_configs["toc"]["slugify"] = github_anchor
    return config


def _filled(entry: Any, titles: dict[str, str]) -> Any:
    if isinstance(entry, list):
        return [_filled(each, titles) for each in entry]
    if isinstance(entry, dict):
        return {title: _filled(each, titles) for title, each in entry.items()}
    return generated_nav(entry, titles) if entry.endswith("/") else entry


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Replace the files of the folder docs by those of the repository, under their paths there."""
    from mkdocs.structure.files import File, Files

    theme = [file for file in files if file.inclusion.is_included() and file.src_dir != config.docs_dir]
    own = [
        File(path, str(ROOT), config.site_dir, config.use_directory_urls)
        for path in (*repository_pages(), *repository_pictures())
    ]
    made = [File.generated(config, path, content=text) for path, (_, text) in _pages().items()]
    return Files([*theme, *own, *made])


def on_page_markdown(markdown: str, page: Page, config: MkDocsConfig, files: Files) -> str:  # noqa: ARG001 - MkDocs passes it
    """Convert links and lists of a page."""
    path = page.file.src_uri
    if path == "CHANGELOG.md":
        page.meta["search"] = {"exclude": True}  # it names everything once more
    if _is_french(page):
        page.meta["search"] = {"boost": 0.5}  # most queries are English
    if path == "docs/troubleshooting.md":
        page.meta["search"] = {"boost": 2}  # who searches for a symptom wants its remedy
    if path == "docs/robots.md":
        page.meta["search"] = {"boost": 2}  # the first page about worlds with robots; "robot" is in 100 other titles
    if path.startswith(("reference/python/", "reference/messages/", "reference/diagnostics/", "reference/plugins/")):
        page.meta["search"] = {"boost": 0.5}  # each of their 2000 names is a title
    if not path.startswith("reference/"):
        markdown = in_python_markdown(with_site_links(markdown, path, files.src_uris))
        markdown = with_options_link(markdown, path, _pages())
        markdown = with_plugin_links(markdown, path, _anchors())
    return markdown


def _is_french(page: Page) -> bool:
    path = page.file.src_uri
    return path.endswith(".fr.md") or path in ("docs/cours.md", "docs/start/etudiant.md")


def on_post_page(output: str, page: Page, config: MkDocsConfig) -> str:  # noqa: ARG001 - MkDocs passes it
    """Declare the language of a French page, for screen readers and for translations by the browser."""
    return output.replace('<html lang="en"', '<html lang="fr"', 1) if _is_french(page) else output


def on_page_content(html: str, page: Page, config: MkDocsConfig, files: Files) -> str:  # noqa: ARG001 - MkDocs passes it
    """Keep each option in code on one line: a browser breaks lines after hyphens."""
    return _INLINE_CODE.sub(lambda code: _OPTION.sub(r'<span class="option">\g<0></span>', code[0]), html)
