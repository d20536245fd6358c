"""What was learned as one page that any browser opens by itself: clusters, directions, places, graphlets, sizes."""

from executor.knowledge_page.page import knowledge_page, knowledge_sections

__all__ = ["knowledge_page", "knowledge_sections"]
