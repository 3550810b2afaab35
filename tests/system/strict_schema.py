"""JSON schemas that permit no member but those that they describe, so that a new member must be described."""
import copy


def strict(schema):
    """A copy of `schema` in which objects have no other members than their properties, unless it permits others itself."""
    schema = copy.deepcopy(schema)

    def close(part):
        if isinstance(part, dict):
            if "properties" in part:
                part.setdefault("additionalProperties", False)
            for value in part.values():
                close(value)
        elif isinstance(part, list):
            for value in part:
                close(value)

    close(schema)
    return schema
