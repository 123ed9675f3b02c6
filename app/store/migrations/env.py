"""Lets Alembic migrate over the connection that `app.store.database` has opened."""

from alembic import context

from app.store.schema import Table

context.configure(connection=context.config.attributes["connection"], target_metadata=Table.metadata)
with context.begin_transaction():
    context.run_migrations()
