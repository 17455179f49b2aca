"""Revisions say what ended their layout early."""

import sqlalchemy as sa
from alembic import op

revision = "0002"
down_revision = "0001"
branch_labels = None
depends_on = None


def upgrade() -> None:
    """Add the column."""
    op.add_column("revisions", sa.Column("stopped_by", sa.String(length=20), nullable=True))


def downgrade() -> None:
    """Take it away."""
    op.drop_column("revisions", "stopped_by")
