"""The public names, for type checkers and for ``__init__.py``, which imports each when it is first used."""

from toongeo.editing.attention_map import attention_map as attention_map
from toongeo.editing.compose_texture import compose_texture as compose_texture
from toongeo.editing.edit_expression import edit_expression as edit_expression
from toongeo.editing.expression_editor import ExpressionEditor as ExpressionEditor
from toongeo.editing.texture_generator import ClassicalTextureGenerator as ClassicalTextureGenerator
