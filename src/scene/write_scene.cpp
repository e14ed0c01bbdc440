#include "scene/write_scene.h"

#include "scene/field_format.h"
#include "scene/shape_fields.h"

#include <fmt/format.h>

namespace sandflow {
namespace {

/// Visitor of the fields that appends "key = value" lines.
class FieldWriter {
public:
    explicit FieldWriter(std::string& text) : text_(text) {}

    template <class Value, class Rule>
    void operator()(const Key& key, const Value& value, const Rule& rule)
    {
        const std::string formatted = formatValue(value, rule);
        if (!formatted.empty()) {
            text_ += std::string(key.name) + " = " + formatted + '\n';
        }
    }

private:
    std::string& text_;
};

}  // namespace

std::string writeScene(const Scene& scene)
{
    std::string text;
    FieldWriter write(text);
    visitFields(scene, write);
    visitTables(scene, [&](const char* name, const char*, const auto& spec) {
        const std::string header = fmt::format("\n[{}]\n", name);
        text += header;
        visitFields(spec, write);
        if (text.ends_with(header)) {
            text.resize(text.size() - header.size());  // an open domain has nothing to say
        }
    });
    visitLists(scene, [&](const char* name, const char*, const auto& list) {
        for (const auto& spec : list) {
            text += fmt::format("\n[[{}]]\n", name);
            visitFields(spec, write);
        }
    });
    return text;
}

}  // namespace sandflow
