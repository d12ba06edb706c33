#include "tools/chart/page.h"

#include <duktape.h>

#include <memory>
#include <string_view>

#include "tools/chart/assets.h"

namespace huestep::tools::chart {
namespace {

/// JSON that may stand in a script of a page: nothing in it can end the script.
std::string scriptText(const Json& document) {
    std::string text = document.dump(-1, ' ', false, Json::error_handler_t::replace);
    for (std::size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at))
        text.replace(at, 1, "\\u003c");
    return text;
}

/// The page's template has a line `<!-- name -->` where each part goes.
std::string filled(std::string_view page, const std::string& name, std::string_view text) {
    const std::string mark = "<!-- " + name + " -->";
    const std::size_t at = page.find(mark);
    std::string whole(page.substr(0, at));
    whole += text;
    whole += page.substr(at + mark.size());
    return whole;
}

std::string element(const std::string& tag, std::string_view text) {
    return '<' + tag + ">\n" + std::string(text) + "\n</" + tag.substr(0, tag.find(' ')) + '>';
}

struct HeapOff {
    void operator()(duk_context* heap) const { duk_destroy_heap(heap); }
};

/// A script and what it ends with, as text; fails with the script's own words.
Result<std::string> evaluate(duk_context* heap, std::string_view script) {
    const bool failed = duk_peval_lstring(heap, script.data(), script.size()) != 0;
    std::string text = duk_safe_to_string(heap, -1);
    duk_pop(heap);
    if (failed) return Error{"a chart could not be drawn: " + text};
    return text;
}

}  // namespace

std::string pageOf(const Json& document) {
    std::string page(assets::pageHtml);
    page = filled(page, "style", element("style", assets::pageStyle));
    page = filled(page, "library", element("script", assets::library));
    page = filled(page, "charts", element("script", assets::charts));
    page = filled(page, "script", element("script", assets::pageScript));
    return filled(
        page, "data",
        element("script id=\"document\" type=\"application/json\"", scriptText(document)));
}

Result<bool> drawPictures(const Json& document, const TakePicture& take) {
    const std::unique_ptr<duk_context, HeapOff> heap(duk_create_heap_default());
    if (!heap) return Error{"a chart could not be drawn: there is no memory"};
    // Read as JSON, for a script may not name as many constants as there are figures.
    const std::string text = document.dump(-1, ' ', false, Json::error_handler_t::replace);
    duk_push_lstring(heap.get(), text.data(), text.size());
    duk_json_decode(heap.get(), -1);
    duk_put_global_string(heap.get(), "document_");
    // The library waits for its next frame with timers, which there are none of here: each picture
    // is drawn at once.
    for (const std::string_view script : {std::string_view("var setTimeout = function () {}; null"),
                                          assets::library, assets::charts})
        if (const Result<std::string> done = evaluate(heap.get(), script); !done)
            return done.error();
    const Result<std::string> count = evaluate(
        heap.get(), "var pictures_ = huestepCharts.pictures(echarts, document_); pictures_.length");
    if (!count) return count.error();
    const std::size_t pictures = std::stoul(*count);
    for (std::size_t i = 0; i < pictures; ++i) {
        const Result<std::string> drawn =
            evaluate(heap.get(), "JSON.stringify(pictures_[" + std::to_string(i) + "]())");
        if (!drawn) return drawn.error();
        const Json each = Json::parse(*drawn);
        const Result<bool> goOn =
            take({each.at("name").get<std::string>(), each.at("svg").get<std::string>()}, i + 1,
                 pictures);
        if (!goOn || !*goOn) return goOn;
    }
    return true;
}

}  // namespace huestep::tools::chart
