#include "scene/scene_reference.h"

#include "scene/field_reader.h"
#include "scene/shape_fields.h"

#include <fmt/format.h>

#include <algorithm>

namespace sandflow {
namespace {

/// Visitor of the fields that makes one table row of each.
struct RowMaker {
    std::vector<std::string> rows;

    template <class Value, class Rule>
    void operator()(const Key& key, const Value& value, const Rule& rule)
    {
        std::string initial = formatValue(value, rule);
        if (key.need == Need::required) {
            initial = "**required**";
        } else if (initial.empty() || initial == "\"\"") {
            initial = "-";
        } else {
            for (auto at = initial.find("-0.0"); at != std::string::npos;
                 at = initial.find("-0.0")) {
                initial.erase(at, 1);  // the sign of a zero is noise to a reader
            }
            initial = '`' + initial + '`';
        }
        rows.push_back(fmt::format("| `{}` | {} | {} | {} |\n", key.name,
                                   joinUnit(describeField(value, rule), key.unit), initial,
                                   key.meaning));
    }
};

template <class Spec>
std::vector<std::string> makeRows(const Spec& spec)
{
    RowMaker maker;
    visitFields(spec, maker);
    return maker.rows;
}

std::string writeTable(const std::string& title, const std::string& text,
                       const std::vector<std::string>& rows)
{
    std::string table = fmt::format("### {}\n\n{}{}", title, text, text.empty() ? "" : "\n\n");
    table += "| key | value | default | meaning |\n|---|---|---|---|\n";
    for (const std::string& row : rows) {
        table += row;
    }
    return table + '\n';
}

/// What all shapes (or kinds) share, then what each has of its own.
template <class Spec>
std::string writeVariantTables(const std::string& list, const std::string& meaning)
{
    const auto variants = makeVariants(Spec{});
    std::vector<std::string> shared = makeRows(variants.front().spec);
    for (const auto& variant : variants) {
        const auto rows = makeRows(variant.spec);
        std::erase_if(shared, [&](const std::string& row) {
            return std::find(rows.begin(), rows.end(), row) == rows.end();
        });
    }
    std::string text = writeTable("`[[" + list + "]]`", meaning + " Keys of all of them:", shared);
    for (const auto& variant : variants) {
        auto rows = makeRows(variant.spec);
        std::erase_if(rows, [&](const std::string& row) {
            return std::find(shared.begin(), shared.end(), row) != shared.end();
        });
        KeyCollector selector;
        visitSelector(variant.spec, selector);
        text += writeTable(
            fmt::format("`[[{}]]` with `{} = \"{}\"`", list, selector.names.front(), variant.name),
            "", rows);
    }
    return text;
}

}  // namespace

std::string writeSceneReference()
{
    const Scene scene;
    std::string text = writeTable("Top of the file", "Before the first table.", makeRows(scene));
    visitTables(scene, [&](const char* name, const char* meaning, const auto& spec) {
        text += writeTable(fmt::format("`[{}]`", name), meaning, makeRows(spec));
    });
    visitLists(scene, [&](const char* name, const char* meaning, const auto& list) {
        using Spec = typename std::decay_t<decltype(list)>::value_type;
        text += writeVariantTables<Spec>(name, meaning);
    });
    return text;
}

}  // namespace sandflow
