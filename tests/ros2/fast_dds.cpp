/* Readers of ROS 2 topics by Fast DDS, on the loopback interface, for the tests: fast_dds DOMAIN
 *
 * Each line of the standard input makes a reader: TOPIC TYPE DURABILITY, as `rt/diagnostics
 * diagnostic_msgs::msg::dds_::DiagnosticArray_ volatile`. Each sample is a line of JSON, {"topic": .., "sample": {..}},
 * each change of the number of writers too: {"topic": .., "writers": 1}. The first line is `ready`: its ports are open.
 * The end of the input ends the program. */
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <iostream>
#include <memory>
#include <mutex>
#include <sstream>
#include <string>
#include <vector>

#include <fastcdr/Cdr.h>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>

namespace fast = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
using eprosima::fastcdr::Cdr;
using eprosima::fastcdr::FastBuffer;

namespace {

/* More participants than the tests have in a domain at a time; each has ports of its own. */
const uint32_t PARTICIPANTS = 20;

/* A message as CDR has it, with the four bytes that say which. */
using Bytes = std::vector<char>;

/* The type of any topic: by its name alone, as no sample is looked into before it is taken. */
class AnyType : public fast::TopicDataType {
public:
    explicit AnyType(const std::string &name) {
        setName(name.c_str());
        m_typeSize = 1024;
        m_isGetKeyDefined = false;
        auto_fill_type_object(false);
        auto_fill_type_information(false);
    }
    bool serialize(void *, rtps::SerializedPayload_t *) override { return false; }
    bool deserialize(rtps::SerializedPayload_t *payload, void *data) override {
        static_cast<Bytes *>(data)->assign(payload->data, payload->data + payload->length);
        return true;
    }
    std::function<uint32_t()> getSerializedSizeProvider(void *) override {
        return [] { return 0u; };
    }
    void *createData() override { return new Bytes; }
    void deleteData(void *data) override { delete static_cast<Bytes *>(data); }
    bool getKey(void *, rtps::InstanceHandle_t *, bool) override { return false; }
};

/* Reads the fields of a message one after the other and writes them as JSON. */
class Fields {
public:
    explicit Fields(Bytes &message)
        : buffer(message.data(), message.size()), cdr(buffer, Cdr::DEFAULT_ENDIAN, Cdr::DDS_CDR) {
        cdr.read_encapsulation();
        // Enough to tell any two doubles apart.
        json.precision(17);
    }
    template <typename Number> void number(const char *name) {
        Number value;
        cdr >> value;
        key(name);
        if (std::isnan(double(value)))
            json << "NaN";
        else if (std::isinf(double(value)))
            json << (value < 0 ? "-Infinity" : "Infinity");
        else
            json << double(value);
    }
    void boolean(const char *name) {
        bool value;
        cdr >> value;
        key(name);
        json << (value ? "true" : "false");
    }
    void text(const char *name) {
        std::string value;
        cdr >> value;
        key(name);
        json << '"';
        for (char letter : value) {
            if (letter == '"' || letter == '\\')
                json << '\\';
            json << letter;
        }
        json << '"';
    }
    template <typename Inner> void structure(const char *name, Inner inner) {
        key(name);
        open('{');
        inner(*this);
        close('}');
    }
    template <typename Inner> void sequence(const char *name, Inner inner) {
        uint32_t length;
        cdr >> length;
        list(name, length, inner);
    }
    template <uint32_t LENGTH, typename Inner> void array(const char *name, Inner inner) { list(name, LENGTH, inner); }
    /* Bytes that follow the last field; at most three, which pad the message. */
    size_t left() const { return buffer.getBufferSize() - cdr.getSerializedDataLength(); }
    std::string said() const { return json.str(); }

private:
    template <typename Inner> void list(const char *name, uint32_t length, Inner inner) {
        key(name);
        open('[');
        for (uint32_t i = 0; i < length; i++)
            inner(*this);
        close(']');
    }
    void key(const char *name) {
        json << separator;
        separator = ", ";
        if (name)
            json << '"' << name << "\": ";
    }
    void open(char bracket) {
        json << bracket;
        separator = "";
    }
    void close(char bracket) {
        json << bracket;
        separator = ", ";
    }

    FastBuffer buffer;
    Cdr cdr;
    std::ostringstream json;
    const char *separator = "";
};

void header(Fields &in) {
    in.structure("header", [](Fields &in) {
        in.structure("stamp", [](Fields &in) {
            in.number<int32_t>("sec");
            in.number<uint32_t>("nanosec");
        });
        in.text("frame_id");
    });
}

void range(Fields &in) {
    header(in);
    in.number<uint8_t>("radiation_type");
    for (const char *name : {"field_of_view", "min_range", "max_range", "range", "variance"})
        in.number<float>(name);
}

void laser_scan(Fields &in) {
    header(in);
    for (const char *name :
         {"angle_min", "angle_max", "angle_increment", "time_increment", "scan_time", "range_min", "range_max"})
        in.number<float>(name);
    for (const char *name : {"ranges", "intensities"})
        in.sequence(name, [](Fields &in) { in.number<float>(nullptr); });
}

void point_cloud(Fields &in) {
    header(in);
    in.number<uint32_t>("height");
    in.number<uint32_t>("width");
    in.sequence("fields", [](Fields &in) {
        in.structure(nullptr, [](Fields &in) {
            in.text("name");
            in.number<uint32_t>("offset");
            in.number<uint8_t>("datatype");
            in.number<uint32_t>("count");
        });
    });
    in.boolean("is_bigendian");
    in.number<uint32_t>("point_step");
    in.number<uint32_t>("row_step");
    in.sequence("data", [](Fields &in) { in.number<uint8_t>(nullptr); });
    in.boolean("is_dense");
}

void diagnostics(Fields &in) {
    header(in);
    in.sequence("status", [](Fields &in) {
        in.structure(nullptr, [](Fields &in) {
            in.number<uint8_t>("level");
            for (const char *name : {"name", "message", "hardware_id"})
                in.text(name);
            in.sequence("values", [](Fields &in) {
                in.structure(nullptr, [](Fields &in) {
                    in.text("key");
                    in.text("value");
                });
            });
        });
    });
}

void numbers(Fields &in, const char *name, std::initializer_list<const char *> keys) {
    in.structure(name, [keys](Fields &in) {
        for (const char *key : keys)
            in.number<double>(key);
    });
}

void transforms(Fields &in) {
    in.sequence("transforms", [](Fields &in) {
        in.structure(nullptr, [](Fields &in) {
            header(in);
            in.text("child_frame_id");
            in.structure("transform", [](Fields &in) {
                numbers(in, "translation", {"x", "y", "z"});
                numbers(in, "rotation", {"x", "y", "z", "w"});
            });
        });
    });
}

void covariance(Fields &in) {
    in.array<36>("covariance", [](Fields &in) { in.number<double>(nullptr); });
}

void odometry(Fields &in) {
    header(in);
    in.text("child_frame_id");
    in.structure("pose", [](Fields &in) {
        in.structure("pose", [](Fields &in) {
            numbers(in, "position", {"x", "y", "z"});
            numbers(in, "orientation", {"x", "y", "z", "w"});
        });
        covariance(in);
    });
    in.structure("twist", [](Fields &in) {
        in.structure("twist", [](Fields &in) {
            numbers(in, "linear", {"x", "y", "z"});
            numbers(in, "angular", {"x", "y", "z"});
        });
        covariance(in);
    });
}

struct Message {
    const char *type;
    void (*fields)(Fields &);
};

const Message MESSAGES[] = {
    {"sensor_msgs::msg::dds_::Range_", range},
    {"sensor_msgs::msg::dds_::LaserScan_", laser_scan},
    {"sensor_msgs::msg::dds_::PointCloud2_", point_cloud},
    {"diagnostic_msgs::msg::dds_::DiagnosticArray_", diagnostics},
    {"tf2_msgs::msg::dds_::TFMessage_", transforms},
    {"nav_msgs::msg::dds_::Odometry_", odometry},
};

/* Writes a line that no other thread's line runs into. */
void say(const std::string &line) {
    static std::mutex one_at_a_time;
    std::lock_guard<std::mutex> held(one_at_a_time);
    std::cout << line << std::endl;
}

/* Says the writers and the samples of one topic. */
class Topic : public fast::DataReaderListener {
public:
    Topic(const std::string &name, const Message &message) : name(name), message(message) {}

    void on_subscription_matched(fast::DataReader *, const fast::SubscriptionMatchedStatus &status) override {
        say("{\"topic\": \"" + name + "\", \"writers\": " + std::to_string(status.current_count) + "}");
    }
    void on_data_available(fast::DataReader *reader) override {
        Bytes bytes;
        fast::SampleInfo info;
        while (reader->take_next_sample(&bytes, &info) == eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK) {
            if (!info.valid_data)
                continue;
            std::string sample;
            try {
                sample = read(bytes);
            } catch (const std::exception &error) {
                sample = std::string("\"") + error.what() + "\"";
            }
            say("{\"topic\": \"" + name + "\", \"sample\": " + sample + "}");
        }
    }

private:
    std::string read(Bytes &bytes) const {
        Fields fields(bytes);
        fields.structure(nullptr, message.fields);
        if (fields.left() > 3)
            return "\"" + std::to_string(fields.left()) + " bytes after the last field\"";
        return fields.said();
    }

    const std::string name;
    const Message &message;
};

fast::DomainParticipantQos on_loopback() {
    auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
    udp->interfaceWhiteList = {"127.0.0.1"};
    udp->maxInitialPeersRange = PARTICIPANTS;
    rtps::Locator_t loopback;
    rtps::IPLocator::setIPv4(loopback, 127, 0, 0, 1);
    fast::DomainParticipantQos qos;
    qos.transport().use_builtin_transports = false;
    qos.transport().user_transports.push_back(udp);
    qos.wire_protocol().builtin.initialPeersList.push_back(loopback);
    return qos;
}

/* As ROS 2's subscriptions ask for it. */
fast::DataReaderQos reliable(const std::string &durability) {
    fast::DataReaderQos qos;
    qos.reliability().kind = fast::RELIABLE_RELIABILITY_QOS;
    qos.history().kind = fast::KEEP_ALL_HISTORY_QOS;
    if (durability == "latched")
        qos.durability().kind = fast::TRANSIENT_LOCAL_DURABILITY_QOS;
    qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
    return qos;
}

int fail(const std::string &why) {
    std::cerr << "fast_dds: " << why << std::endl;
    return 1;
}

} // namespace

int main(int count, char **arguments) {
    if (count != 2)
        return fail("expected a domain");
    auto *participant = fast::DomainParticipantFactory::get_instance()->create_participant(
        std::stoi(arguments[1]), on_loopback());
    auto *subscriber = participant ? participant->create_subscriber(fast::SUBSCRIBER_QOS_DEFAULT) : nullptr;
    if (!subscriber)
        return fail("no participant");
    say("ready");
    std::vector<std::unique_ptr<Topic>> topics;
    std::string name, type, durability;
    while (std::cin >> name >> type >> durability) {
        const Message *known = nullptr;
        for (const Message &message : MESSAGES)
            if (type == message.type)
                known = &message;
        if (!known)
            return fail(type + ": unknown type");
        fast::TypeSupport(new AnyType(type)).register_type(participant);
        auto *topic = participant->create_topic(name, type, fast::TOPIC_QOS_DEFAULT);
        topics.push_back(std::make_unique<Topic>(name, *known));
        if (!topic || !subscriber->create_datareader(topic, reliable(durability), topics.back().get()))
            return fail(name + ": no reader");
    }
    participant->delete_contained_entities();
    fast::DomainParticipantFactory::get_instance()->delete_participant(participant);
    return 0;
}
