"""Names of the parts of a head: sides, mouth, sockets."""

__all__ = ["INNER_PARTS", "MOUTH_PARTS", "SIDES", "SOCKETS", "TEETH", "TEETH_AND_TONGUE"]

SIDES = ("left", "right")  # the subject's; eye 0 is the left one
SOCKETS = ("socket_left", "socket_right")
TEETH = ("teeth_upper", "teeth_lower")
TEETH_AND_TONGUE = (*TEETH, "tongue")
MOUTH_PARTS = ("mouth_cavity", *TEETH_AND_TONGUE)
INNER_PARTS = ("mouth_cavity", *SOCKETS, *TEETH_AND_TONGUE)  # regions that lie behind the skin
