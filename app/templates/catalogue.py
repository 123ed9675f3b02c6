"""The templates that there are, in the order in which they are shown."""

from app.templates import round_cloth, scarf, shirt, skirt, t_shirt, tie, towel, trousers, vest
from app.templates.template import Template

TEMPLATES: tuple[Template, ...] = (
    t_shirt.TEMPLATE,
    vest.TEMPLATE,
    shirt.TEMPLATE,
    trousers.TEMPLATE,
    skirt.TEMPLATE,
    towel.TEMPLATE,
    scarf.TEMPLATE,
    tie.TEMPLATE,
    round_cloth.TEMPLATE,
)


def find_template(name: str) -> Template | None:
    """The template of a name; None if there is none."""
    return next((template for template in TEMPLATES if template.name == name), None)
