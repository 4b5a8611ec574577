"""A ring of HC-SR04 modules in ESPHome, with a sensor for each; docs/how-to/boards.md has an example."""

import esphome.codegen as cg
import esphome.config_validation as cv
from esphome import pins
from esphome.components import sensor
from esphome.const import CONF_ECHO_PIN, CONF_ID, CONF_TRIGGER_PIN, DEVICE_CLASS_DISTANCE, STATE_CLASS_MEASUREMENT, UNIT_METER

AUTO_LOAD = ["sensor"]
RING = cg.esphome_ns.namespace("eeruf").class_("Ring", cg.PollingComponent)
# Window, blanking, least and most quiet, rest, and the longest echo, in us: as `eeruf design --way flow --emit c` says.
MODULES = {"hc-sr04": (24310, 117, 6028, 33159, 60000, 36000), "jsn-sr04t": (35965, 1166, 8402, 46212, 70000, 56826)}
MODULES["hc-sr04-clone"] = (24310, 117, 6028, 33159, 210000, 189468)
SENSOR = sensor.sensor_schema(
    unit_of_measurement=UNIT_METER, accuracy_decimals=2, device_class=DEVICE_CLASS_DISTANCE, state_class=STATE_CLASS_MEASUREMENT
).extend(
    {
        cv.Required(CONF_TRIGGER_PIN): pins.internal_gpio_output_pin_schema,
        cv.Required(CONF_ECHO_PIN): pins.internal_gpio_input_pin_schema,
    }
)
CONFIG_SCHEMA = cv.Schema(
    {
        cv.GenerateID(): cv.declare_id(RING),
        cv.Optional("module", default="hc-sr04"): cv.one_of(*MODULES, lower=True),
        cv.Required("ring"): cv.All(cv.ensure_list(SENSOR), cv.Length(min=1, max=64)),
    }
).extend(cv.polling_component_schema("1s"))


async def to_code(config):
    count = cg.TemplateArguments(len(config["ring"]))
    ring = cg.new_Pvariable(config[CONF_ID], count, *MODULES[config["module"]])
    await cg.register_component(ring, config)
    for one in config["ring"]:
        trigger, echo = [await cg.gpio_pin_expression(one[pin]) for pin in (CONF_TRIGGER_PIN, CONF_ECHO_PIN)]
        cg.add(ring.add(await sensor.new_sensor(one), trigger, echo))
