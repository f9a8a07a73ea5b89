"""What tests look up in the chapters of a report."""


def chapter(report, title):
    (found,) = (one for one in report.document.chapters if one.title == title)
    return found


def rows(report, title, caption):
    tables = [
        part for part in chapter(report, title).parts if getattr(part, "caption", "").startswith(caption)
    ]
    return {row[0].text: [cell.text for cell in row] for row in tables[0].rows}
