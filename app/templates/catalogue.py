"""The catalogue of templates, in the order shown."""

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
    """Return the template with a name, or None."""
    return next((template for template in TEMPLATES if template.name == name), None)
