// Worlds for a page: made of scenes and snapshots, stepped, hashed, and taken back.
#include "client/wasm/exports.h"
#include "core/scene/catalog.h"
#include "core/world/world.h"

namespace huestep::wasm {

namespace {

World* madeOf(Result<World>&& world, Bytes& why) {
    if (world) return new World(std::move(*world));
    write(why, world.error().message);
    return nullptr;
}

}  // namespace

/// How many numbers the module's instructions work on side by side: 1 or 4.
HUESTEP_EXPORT(lanes)()->std::uint32_t {
    return availableSimd().back() == Simd::Scalar ? 1 : 4;
}

/// Bytes that go in or out. Null if more than `maxBytes` are asked for.
HUESTEP_EXPORT(bytesNew)(std::uint32_t size)->Bytes* {
    return size <= maxBytes ? new Bytes(size) : nullptr;
}
/// Of another size, the first ones as they were; 0 if they cannot be so many.
HUESTEP_EXPORT(bytesResize)(Bytes* bytes, std::uint32_t size)->std::uint32_t {
    if (size > maxBytes) return 0;
    bytes->resize(size);
    return 1;
}
HUESTEP_EXPORT(bytesAt)(Bytes* bytes)->std::byte* {
    return bytes->data();
}
HUESTEP_EXPORT(bytesSize)(const Bytes* bytes)->std::uint32_t {
    return bytes->size();
}
HUESTEP_EXPORT(bytesDelete)(Bytes* bytes)->void {
    delete bytes;
}

/// A world of a built-in scene, from a text such as `pyramid:base=20`.
HUESTEP_EXPORT(worldOfScene)(const Bytes* text, Bytes* why)->World* {
    const Result<Scene> scene = sceneFromCatalog(textOf(*text));
    if (!scene) return madeOf(scene.error(), *why);
    return madeOf(World::create(*scene), *why);
}
/// The world that a snapshot is of, wherever it was saved.
HUESTEP_EXPORT(worldOfSnapshot)(const Bytes* snapshot, Bytes* why)->World* {
    return madeOf(World::restore(*snapshot), *why);
}
HUESTEP_EXPORT(worldDelete)(World* world)->void {
    delete world;
}

/// One step to which nobody says anything.
HUESTEP_EXPORT(worldStep)(World* world)->void {
    world->step({});
}

HUESTEP_EXPORT(worldTick)(const World* world)->std::uint64_t {
    return world->tick();
}
HUESTEP_EXPORT(worldMotionRoot)(const World* world)->std::uint64_t {
    return world->motionRoot();
}
HUESTEP_EXPORT(worldFullRoot)(const World* world)->std::uint64_t {
    return world->fullRoot();
}

/// How many bodies there are, by id.
HUESTEP_EXPORT(worldBodyCount)(const World* world)->std::uint32_t {
    return world->bodies().size();
}
/// What moves, 32 bytes a body: floats x, y of the centre of mass in m, cosine and sine of its
/// angle, velocity x, y in m/s, angular velocity in rad/s; then 16 bits of which the highest is set
/// while the body sleeps, and 16 others.
HUESTEP_EXPORT(worldMotions)(const World* world)->const BodyMotion* {
    return world->motions().data();
}

/// An exact image of the world, for `worldOfSnapshot` here or anywhere.
HUESTEP_EXPORT(worldSave)(const World* world, Bytes* into)->void {
    *into = world->save();
}

/// An image within this instance, to go back to; cheap where it is taken again and again.
HUESTEP_EXPORT(checkpointNew)()->Checkpoint* {
    return new Checkpoint();
}
HUESTEP_EXPORT(checkpointDelete)(Checkpoint* checkpoint)->void {
    delete checkpoint;
}
HUESTEP_EXPORT(worldCheckpoint)(const World* world, Checkpoint* into)->void {
    world->checkpoint(*into);
}
/// The world as it was when the checkpoint was taken; 0 if it never was.
HUESTEP_EXPORT(worldGoBack)(World* world, const Checkpoint* to)->std::uint32_t {
    if (to->empty()) return 0;
    world->restore(*to);
    return 1;
}

}  // namespace huestep::wasm
