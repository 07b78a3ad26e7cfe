"""The twenty-first table of forms for a report, and how a form enters it."""

from functools import partial

from tests.discovery.joint_generator.forms import form as _form

UNSEEN_TWENTYFIRST: dict[str, _form.Form] = {}
form = partial(_form.form, table=UNSEEN_TWENTYFIRST)
