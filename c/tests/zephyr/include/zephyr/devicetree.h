/* Stands in for Zephyr's header of this name: see ../../board.c. The pins come from the sample's overlay: overlay.h,
 * which `cargo xtask c` writes, defines OVERLAY_trigger_gpios and OVERLAY_echo_gpios, macros that list all pins with a
 * separator, and the specifications PIN_trigger_gpios_0 and so on. */
#pragma once

#include "overlay.h"

#define DT_COMPAT_GET_ANY_STATUS_OKAY(compatible) DT_NODE_##compatible
#define DT_FOREACH_PROP_ELEM_SEP(node, property, macro, separator)                                                     \
    OVERLAY_##property(node, macro, UNBRACKETED separator)
#define UNBRACKETED(...) __VA_ARGS__
