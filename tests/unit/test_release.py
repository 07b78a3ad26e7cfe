"""What a release consists of agrees with itself: versions, dependencies, links."""

import re
import tomllib
from pathlib import Path

import pytest

from stochfric_mb import __version__

ROOT = Path(__file__).parents[2]
pytestmark = pytest.mark.skipif(not (ROOT / "pyproject.toml").is_file(), reason="installed without the project's files")


def _read(name):
    return (ROOT / name).read_text(encoding="utf-8")


def test_citation_and_recipe_have_the_version():
    assert f"version: {__version__}\n" in _read("CITATION.cff")
    assert f'version: "{__version__}"' in _read("conda/recipe.yaml")


def test_the_recipe_has_the_dependencies():
    recipe = _read("conda/recipe.yaml").replace("matplotlib-base", "matplotlib")
    needed = tomllib.loads(_read("pyproject.toml"))["project"]["dependencies"]
    run = recipe.partition("  run:\n")[2].partition("  run_constraints")[0]
    listed = {line.strip("- ").replace(" ", "") for line in run.splitlines()}
    assert listed == {*needed, "python>=3.11"}


@pytest.mark.parametrize("page", sorted(str(p.relative_to(ROOT)) for p in [*ROOT.glob("*.md"), *ROOT.glob("docs/*.md")]))
def test_links_lead_somewhere(page):
    for target in re.findall(r"\]\(([^)\s]+)\)", re.sub(r"```.*?```", "", _read(page), flags=re.DOTALL)):
        if "://" not in target and not target.startswith("#"):
            assert ((ROOT / page).parent / target.partition("#")[0]).exists(), f"{page}: {target}"


def test_no_page_and_no_message_installs_from_an_index_that_has_nothing():
    for page in [*ROOT.glob("docs/*.md"), *ROOT.glob("stochfric_mb/**/*.py")]:
        assert "pip install 'stochfric_mb" not in page.read_text(encoding="utf-8"), page


def test_the_site_has_every_page():
    listed = set(re.findall(r"([\w/]+\.md)$", _read("mkdocs.yml"), re.MULTILINE))
    assert listed == {p.name for p in (ROOT / "docs").glob("*.md")}


def test_the_map_names_rooms_that_exist():
    for name in re.findall(r"^\| (.*?) \|", _read("CONTRIBUTING.md"), re.MULTILINE):
        for room in re.findall(r"`([\w/]+(?:\.py)?)`", name):
            assert (ROOT / "stochfric_mb" / room).exists() or (ROOT / room).exists(), room


def test_the_changelog_has_a_section_for_what_is_not_released():
    assert "## Unreleased" in _read("CHANGELOG.md")
