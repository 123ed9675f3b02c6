"""Make the tables of documents, their steps and garments; jobs have a server."""

import sqlalchemy as sa
from alembic import op

revision = "0002"
down_revision = "0001"


def upgrade() -> None:
    """Make the tables and the column."""
    op.add_column("jobs", sa.Column("server", sa.BigInteger(), nullable=False, server_default="0"))
    op.create_table(
        "documents",
        sa.Column("id", sa.String(), primary_key=True),
        sa.Column("format", sa.Integer(), nullable=False),
        sa.Column("revision", sa.Integer(), nullable=False),
        sa.Column("version", sa.Integer(), nullable=False),
        sa.Column("changed_at", sa.String(), nullable=False),
        sa.Column("opened_s", sa.Double(), nullable=True),
        sa.Column("title", sa.String(), nullable=False),
        sa.Column("name", sa.String(), nullable=False),
        sa.Column("first", sa.Integer(), nullable=False),
        sa.Column("now", sa.Integer(), nullable=False),
        sa.Column("problem", sa.Text(), nullable=True),
        sa.Column("start", sa.Text(), nullable=True),
        sa.Column("preview_version", sa.Integer(), nullable=True),
        sa.Column("preview_label", sa.String(), nullable=True),
        sa.Column("preview", sa.Text(), nullable=True),
    )
    op.create_index("documents_by_change", "documents", ["changed_at", "id"])
    op.create_table(
        "document_steps",
        sa.Column("document_id", sa.String(), sa.ForeignKey("documents.id", ondelete="CASCADE"), primary_key=True),
        sa.Column("number", sa.Integer(), primary_key=True),
        sa.Column("label", sa.Text(), nullable=False),
        sa.Column("changed_at", sa.String(), nullable=False),
        sa.Column("drawing", sa.Text(), nullable=False),
    )
    op.create_table(
        "garments",
        sa.Column("name", sa.String(), primary_key=True),
        sa.Column("content", sa.Text(), nullable=False),
    )


def downgrade() -> None:
    """Remove the tables and the column."""
    op.drop_column("jobs", "server")
    for table in ("garments", "document_steps", "documents"):
        op.drop_table(table)
