#include "scene/read_scene.h"

#include "scene/field_reader.h"
#include "scene/scene_checks.h"
#include "scene/shape_fields.h"
#include "scene/solve_friction.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace sandflow {
namespace {

std::string explainNothing(const std::string&)
{
    return "";
}

template <class Spec>
std::vector<std::string> listKeys(const Spec& spec)
{
    KeyCollector collector;
    visitFields(spec, collector);
    return collector.names;
}

/// Keys of any shape or kind.
template <class Spec>
std::vector<std::string> listAllKeys()
{
    std::vector<std::string> all;
    for (const auto& variant : makeVariants(Spec{})) {
        for (const std::string& name : listKeys(variant.spec)) {
            if (std::find(all.begin(), all.end(), name) == all.end()) {
                all.push_back(name);
            }
        }
    }
    return all;
}

/// "does not belong to a plane, only to box, cylinder", or "" if the key belongs nowhere.
template <class Spec>
std::string explainMisplaced(const std::string& key, const std::string& here)
{
    std::string owners;
    for (const auto& variant : makeVariants(Spec{})) {
        const auto keys = listKeys(variant.spec);
        if (std::find(keys.begin(), keys.end(), key) != keys.end()) {
            owners += (owners.empty() ? "" : ", ") + variant.name;
        }
    }
    return owners.empty() ? "" : fmt::format("does not belong to a {}, only to {}", here, owners);
}

/// One [table].
template <class Spec>
void readTable(const SceneSource& source, const toml::table& table, const std::string& name,
               Spec& spec)
{
    FieldReader reader(source, table, name);
    reader.refuseUnknown(listKeys(spec), explainNothing);
    visitFields(spec, reader);
}

/// One element of [[solids]] or [[emitters]]: the shape or kind first, as it decides what else may
/// stand there.
template <class Spec>
void readElement(const SceneSource& source, const toml::table& table, const std::string& name,
                 std::vector<Spec>& list)
{
    FieldReader reader(source, table, name);
    reader.refuseUnknown(listAllKeys<Spec>(), explainNothing);
    Spec chosen;
    visitSelector(chosen, reader);

    KeyCollector selector;
    visitSelector(chosen, selector);
    const auto here = table.get(selector.names.front())->value_or<std::string>("");

    Spec spec = makeDefaultLike(chosen);
    reader.refuseUnknown(listKeys(spec),
                         [&](const std::string& key) { return explainMisplaced<Spec>(key, here); });
    visitFields(spec, reader);
    list.push_back(std::move(spec));
}

/// The keys at the top of the file: values, tables and lists.
void refuseUnknownTop(const FieldReader& top, const Scene& scene)
{
    std::vector<std::string> names = listKeys(scene);
    const auto collect = [&](const char* name, const char*, const auto&) {
        names.emplace_back(name);
    };
    visitTables(scene, collect);
    visitLists(scene, collect);
    top.refuseUnknown(names, explainNothing);
}

Scene buildScene(const SceneSource& source)
{
    Scene scene;
    scene.sourcePath = source.path();
    scene.name = std::filesystem::path(source.path()).stem().string();

    FieldReader top(source, source.root(), "");
    refuseUnknownTop(top, scene);
    visitFields(scene, top);

    visitTables(scene, [&](const char* name, const char*, auto& spec) {
        const toml::node* node = source.root().get(name);
        if (node == nullptr) {
            return;
        }
        if (!node->is_table()) {
            source.fail(name, node->source().begin,
                        fmt::format("is {}, expected a table [{}]", nameType(*node), name));
        }
        readTable(source, *node->as_table(), name, spec);
    });

    visitLists(scene, [&](const char* name, const char*, auto& list) {
        const toml::node* node = source.root().get(name);
        if (node == nullptr) {
            return;
        }
        const toml::array* array = node->as_array();
        if (array == nullptr) {
            source.fail(
                name, node->source().begin,
                fmt::format("is {}, expected a list of tables [[{}]]", nameType(*node), name));
        }
        for (std::size_t i = 0; i < array->size(); ++i) {
            const std::string key = fmt::format("{}[{}]", name, i);
            const toml::node& element = *array->get(i);
            if (!element.is_table()) {
                source.fail(key, element.source().begin,
                            fmt::format("is {}, expected a table", nameType(element)));
            }
            readElement(source, *element.as_table(), key, list);
        }
    });

    solveFriction(source, scene.contact);
    checkScene(scene, [&](const std::vector<std::string>& keys, const std::string& problem) {
        source.fail(keys, problem);
    });
    return scene;
}

}  // namespace

Scene readScene(const std::string& path, const std::vector<std::string>& overrides)
{
    return parseScene(readSceneText(path), path, overrides);
}

Scene parseScene(const std::string& text, const std::string& path,
                 const std::vector<std::string>& overrides)
{
    return buildScene(SceneSource(text, path, overrides));
}

}  // namespace sandflow
