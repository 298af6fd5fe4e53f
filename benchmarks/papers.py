"""Numbers of the five papers that take seconds: what each prints, beside what the same formula or data gives here.

Rows are those of the manual's pages on the papers, in whose tables they stand word for word.  What takes longer, passes
that are made and judged, is in the benchmarks that the other rows of these pages name.
``python -m benchmarks papers jang2021`` prints one paper.
"""

from collections.abc import Sequence

from benchmarks._paper_rows import PAPERS


def main(papers: Sequence[str] = tuple(PAPERS)) -> None:
    """Print a table for each paper, as Markdown.

    Parameters
    ----------
    papers : sequence of str
        Keys of resources/references.bib.
    """
    for key in papers:
        print(f"\n{key}\n\n| quantity | printed | ours |\n|---|---|---|")
        for row in PAPERS[key]():
            print(f"| {row.quantity} | {row.printed} | {row.ours} |", flush=True)


def run_with(words: Sequence[str]) -> int:
    """Only the papers that are named.

    Parameters
    ----------
    words : sequence of str
    """
    unknown = sorted(set(words) - set(PAPERS))
    if unknown:
        print(f"no paper has the key {unknown[0]}: there are {', '.join(PAPERS)}")
        return 2
    main(words)
    return 0


if __name__ == "__main__":
    main()
