"""Pages inside notebooks."""

import html


def embed(page: str, title: str) -> str:
    """A page as an element of another one: it runs its own script, and has no access to what surrounds it."""
    attributes = f'title="{html.escape(title)}" sandbox="allow-scripts allow-downloads" loading="lazy"'
    style = "width: 100%; height: 46rem; border: 1px solid #8884"
    return f'<iframe {attributes} style="{style}" srcdoc="{html.escape(page)}"></iframe>'
