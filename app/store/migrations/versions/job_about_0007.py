"""Tell what a job is about."""

import sqlalchemy as sa
from alembic import op

revision = "0007"
down_revision = "0006"


def upgrade() -> None:
    """Add the column; jobs from before are about nothing."""
    op.add_column("jobs", sa.Column("about", sa.Text(), nullable=False, server_default=""))


def downgrade() -> None:
    """Remove the column."""
    with op.batch_alter_table("jobs") as jobs:
        jobs.drop_column("about")
