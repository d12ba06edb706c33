/// `huestep scenes`: the built-in scenes.
#include <cstdio>
#include <memory>

#include "core/scene/catalog.h"
#include "tools/command.h"
#include "tools/text.h"

namespace huestep::tools {
namespace {

/// What has to be built to be known.
struct Built {
    std::size_t bodies = 0;
    std::string rules;  ///< by which it is played; empty: none
};

Built built(const CatalogEntry& entry) {
    const Result<Scene> scene = sceneFromCatalog(entry.name);
    if (!scene) return {};
    return {scene->bodies.size(), scene->rules ? scene->rules->name : std::string()};
}

Json asJson(std::span<const SceneParameter> parameters) {
    Json json = Json::array();
    for (const SceneParameter& p : parameters)
        json.push_back({{"name", p.name},
                        {"standard", p.standard},
                        {"low", p.low},
                        {"high", p.high},
                        {"meaning", p.meaning}});
    return json;
}

Json asJson(const CatalogEntry& entry) {
    const Built scene = built(entry);
    return {{"name", entry.name},
            {"purpose", entry.purpose},
            {"bodies", scene.bodies},
            {"ticks", entry.ticks},
            {"scripted", entry.script != nullptr},
            {"rules", scene.rules},
            {"parameters", asJson(std::span(entry.parameters))}};
}

Answer showScenes(bool json) {
    if (json) {
        Json scenes = Json::array();
        for (const CatalogEntry& entry : sceneCatalog()) scenes.push_back(asJson(entry));
        print(Json{{"scenes", scenes}, {"common_parameters", asJson(commonParameters())}});
        return Exit::Done;
    }
    Table table({"scene", "bodies", "ticks", "host", "purpose"});
    Table parameters({"scene", "parameter", "standard", "from", "to", "meaning"});
    const auto addParameters = [&](const std::string& scene, std::span<const SceneParameter> list) {
        for (const SceneParameter& p : list)
            parameters.add({scene, std::string(p.name), number(p.standard), number(p.low),
                            number(p.high), std::string(p.meaning)});
    };
    for (const CatalogEntry& entry : sceneCatalog()) {
        const Built scene = built(entry);
        table.add({std::string(entry.name), std::to_string(scene.bodies),
                   std::to_string(entry.ticks), entry.script != nullptr ? "scripted" : scene.rules,
                   std::string(entry.purpose)});
        addParameters(std::string(entry.name), entry.parameters);
    }
    addParameters("every scene", commonParameters());
    table.print();
    std::printf(
        "scripted: the host moves, spawns and removes bodies as a function of the tick; a name: so "
        "do the rules of that game\n\n");
    parameters.print();
    return Exit::Done;
}

}  // namespace

void addScenes(Menu& menu) {
    const auto json = std::make_shared<bool>(false);
    CLI::App* sub = menu.add("scenes", "Lists the built-in scenes, their parameters and purpose.",
                             "huestep scenes --json", [json] { return showScenes(*json); });
    sub->add_flag("--json", *json, "Print one JSON document");
}

}  // namespace huestep::tools
