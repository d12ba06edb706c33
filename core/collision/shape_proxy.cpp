#include "core/collision/shape_proxy.h"

#include <vector>

namespace huestep {

void sortIntoKinds(std::span<ShapeProxy> proxies) {
    struct Kind {
        const ShapeProxy* first = nullptr;
        bool manyBodies = false;
        bool alone = true;
    };
    std::vector<Kind> kinds;
    std::size_t last = 0;  // shapes of a kind come in runs
    const auto isOf = [&](const ShapeProxy& p, const Kind& k) {
        return k.first->filter == p.filter && k.first->dynamic == p.dynamic &&
               k.first->jointed == p.jointed;
    };
    for (ShapeProxy& p : proxies) {
        if (last == kinds.size() || !isOf(p, kinds[last])) {
            for (last = 0; last < kinds.size() && !isOf(p, kinds[last]);) ++last;
        }
        if (last == kinds.size()) {
            if (last == ShapeProxy::unknownKind) {
                for (ShapeProxy& all : proxies) {
                    all.kind = ShapeProxy::unknownKind;
                    all.alone = false;
                }
                return;
            }
            kinds.push_back({&p});
        }
        Kind& kind = kinds[last];
        kind.manyBodies = kind.manyBodies || kind.first->body != p.body;
        p.kind = static_cast<std::uint8_t>(last);
    }
    for (Kind& a : kinds) {
        for (const Kind& b : kinds) {
            if (&a == &b && !a.manyBodies) continue;
            if (mayTouch(a.first->filter, b.first->filter) &&
                (a.first->dynamic || b.first->dynamic)) {
                a.alone = false;
            }
        }
    }
    for (ShapeProxy& p : proxies) p.alone = kinds[p.kind].alone;
}

}  // namespace huestep
