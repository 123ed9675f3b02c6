"""Make the table of links to documents."""

import sqlalchemy as sa
from alembic import op

revision = "0004"
down_revision = "0003"


def upgrade() -> None:
    """Make the table."""
    document = sa.ForeignKey("documents.id", ondelete="CASCADE")
    op.create_table(
        "shares",
        sa.Column("hash", sa.String(), primary_key=True),
        sa.Column("document_id", sa.String(), document, nullable=False),
        sa.Column("created_s", sa.Double(), nullable=False),
    )
    op.create_index("ix_shares_document_id", "shares", ["document_id"])


def downgrade() -> None:
    """Remove the table."""
    op.drop_table("shares")
