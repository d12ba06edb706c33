#include "core/collision/manifold.h"

#include "core/collision/axes.h"

namespace huestep {

namespace {

// Cores nearer than this are treated as touching faces: the direction between two points that
// nearly coincide is noise. A tenth of the 5 mm that the field calls the linear slop.
constexpr double featureTolerance = 0.0005;

constexpr std::uint16_t featureOf(int vertexA, int vertexB) {
    return static_cast<std::uint16_t>((vertexA << 8) | vertexB);
}

/// Surfaces at `coreB − normal·rB` and `coreA + normal·rA`; the contact point lies between them.
template <class Real>
void addPoint(ManifoldT<Real>& m, Vec2T<Real> coreA, Vec2T<Real> coreB, Real separation,
              Real radiusA, Real radiusB, int vertexA, int vertexB) {
    ManifoldPointT<Real>& p = m.points[m.count++];
    const Vec2T<Real> surfaceA = coreA + radiusA * m.normal;
    const Vec2T<Real> surfaceB = coreB - radiusB * m.normal;
    p.point = Real(0.5) * (surfaceA + surfaceB);
    p.separation = separation;
    p.feature = featureOf(vertexA, vertexB);
}

/// One point where two core points are nearest; the normal is the line between them.
template <class Real>
ManifoldT<Real> betweenPoints(Vec2T<Real> coreA, Vec2T<Real> coreB, Real radiusA, Real radiusB,
                              int vertexA, int vertexB, Real margin) {
    ManifoldT<Real> m;
    const Vec2T<Real> d = coreB - coreA;
    const Real distance = length(d);
    const Real separation = distance - (radiusA + radiusB);
    if (separation > margin) return m;
    m.normal = normalized(d);
    if (m.normal == Vec2T<Real>{}) m.normal = {Real(0), Real(1)};  // centres coincide: any way out
    addPoint(m, coreA, coreB, separation, radiusA, radiusB, vertexA, vertexB);
    return m;
}

/// A hull of two or more vertices against a disc, in the frame of the hull.
template <class Real>
ManifoldT<Real> hullAndDisc(const HullT<Real>& a, const HullT<Real>& b, Vec2T<Real> center,
                            Real margin) {
    int best = 0;
    Real separation = dot(a.normals[0], center - a.vertices[0]);
    for (int i = 1; i < a.count; ++i) {
        const Real s = dot(a.normals[asIndex(i)], center - a.vertices[asIndex(i)]);
        if (s > separation) {
            separation = s;
            best = i;
        }
    }
    if (separation - (a.radius + b.radius) > margin) return {};

    const int second = a.next(best);
    const Vec2T<Real> v1 = a.vertices[asIndex(best)];
    const Vec2T<Real> v2 = a.vertices[asIndex(second)];
    // Beyond an end of the edge the vertex is nearest. A centre inside the core has only faces;
    // a core of two vertices has no inside.
    if (a.count == 2 || separation > Real(featureTolerance)) {
        if (dot(center - v1, v2 - v1) < Real(0)) {
            return betweenPoints(v1, center, a.radius, b.radius, best, 0, margin);
        }
        if (dot(center - v2, v1 - v2) < Real(0)) {
            return betweenPoints(v2, center, a.radius, b.radius, second, 0, margin);
        }
    }
    ManifoldT<Real> m;
    m.normal = a.normals[asIndex(best)];
    addPoint(m, center - separation * m.normal, center, separation - (a.radius + b.radius),
             a.radius, b.radius, best, 0);
    return m;
}

/// The edge of `hull` that faces against `normal` the most.
template <class Real>
int incidentEdge(const HullT<Real>& hull, Vec2T<Real> normal) {
    int best = 0;
    Real lowest = dot(hull.normals[0], normal);
    for (int i = 1; i < hull.count; ++i) {
        const Real d = dot(hull.normals[asIndex(i)], normal);
        if (d < lowest) {
            lowest = d;
            best = i;
        }
    }
    return best;
}

/// Cuts the incident edge to the reference edge and keeps the points within the margin.
/// `flipped`: the reference is B. Both hulls are in the frame of A.
template <class Real>
ManifoldT<Real> clipEdges(const HullT<Real>& reference, int edge, const HullT<Real>& incident,
                          bool flipped, Real margin) {
    const Vec2T<Real> normal = reference.normals[asIndex(edge)];
    const int r1 = edge;
    const int r2 = reference.next(edge);
    const int i1 = incidentEdge(incident, normal);
    const int i2 = incident.next(i1);
    const Vec2T<Real> v1 = reference.vertices[asIndex(r1)];
    const Vec2T<Real> v2 = reference.vertices[asIndex(r2)];
    const Vec2T<Real> w1 = incident.vertices[asIndex(i1)];
    const Vec2T<Real> w2 = incident.vertices[asIndex(i2)];

    // Along the reference edge; the incident edge runs the other way, so w2 comes first.
    const Vec2T<Real> tangent = perpLeft(normal);
    const Real extent = dot(v2 - v1, tangent);
    const Real first = dot(w2 - v1, tangent);
    const Real last = dot(w1 - v1, tangent);
    const Real span = last - first;

    ManifoldT<Real> m;
    m.normal = flipped ? -normal : normal;
    const Real radius = reference.radius + incident.radius;
    const auto pointOn = [&](Real along) {
        if (!(span > Real(1e-9))) return w2;
        return w2 + ((along - first) / span) * (w1 - w2);
    };
    const auto keep = [&](Vec2T<Real> p, int referenceVertex, int incidentVertex) {
        const Real core = dot(p - v1, normal);
        const Real separation = core - radius;
        if (separation > margin) return;
        const Vec2T<Real> onReference = p - core * normal;
        if (flipped) {
            addPoint(m, p, onReference, separation, incident.radius, reference.radius,
                     incidentVertex, referenceVertex);
        } else {
            addPoint(m, onReference, p, separation, reference.radius, incident.radius,
                     referenceVertex, incidentVertex);
        }
    };
    if (last < Real(0) || first > extent) {
        // The edges pass each other by: only the nearer ends meet.
        last < Real(0) ? keep(w1, r1, i1) : keep(w2, r2, i2);
        return m;
    }
    // A vertex that is past the end by less than the tolerance is not cut off: where the incident
    // edge is steep, the point at the cut would be far less deep than the vertex.
    const Real slack = Real(featureTolerance);
    const bool cutLow = first < -slack;
    const bool cutHigh = last > extent + slack;
    const Real low = cutLow ? Real(0) : first;
    const Real high = cutHigh ? extent : last;
    keep(cutLow ? pointOn(low) : w2, r1, i2);
    if (high - low > Real(1e-6)) keep(cutHigh ? pointOn(high) : w1, r2, i1);
    return m;
}

template <class Real>
ManifoldT<Real> hulls(const HullT<Real>& a, const HullT<Real>& b, Real margin) {
    const Real radius = a.radius + b.radius;
    const Axis<Real> axisA = bestAxis(a, b);
    if (axisA.separation > radius + margin) return {};
    const Axis<Real> axisB = bestAxis(b, a);
    if (axisB.separation > radius + margin) return {};

    // Prefer A by a little, so that rounding does not make the reference flip back and forth.
    const bool flipped = axisB.separation > axisA.separation + Real(0.1 * featureTolerance);
    const Real separation = flipped ? axisB.separation : axisA.separation;

    // Two cores of two vertices can be apart though no edge normal says so: end to end.
    if (separation > Real(featureTolerance) || (a.count == 2 && b.count == 2)) {
        const Nearest<Real> nearest = nearestPoints(a, b);
        // Two vertices that face each other along the axis but for the tolerance stay with the
        // face: the offset across it is what counts, whatever the distance.
        const Real along = maxOf(separation, Real(0));
        const Real across = Real(featureTolerance);
        if (nearest.twoVertices && nearest.squared > along * along + across * across) {
            return betweenPoints(nearest.pointA, nearest.pointB, a.radius, b.radius,
                                 nearest.vertexA, nearest.vertexB, margin);
        }
    }
    return flipped ? clipEdges(b, axisB.edge, a, true, margin)
                   : clipEdges(a, axisA.edge, b, false, margin);
}

/// Whose business it is to push along a normal that leans over an end of a chain segment.
enum class Pusher { Segment, Face, Neighbour };

/// Where the chain turns away from the front at that end, the normals between the two faces are
/// those of the vertex, which both segments push along, and those beyond are the neighbour's. Where
/// it goes straight on or turns to the front, nothing can meet the vertex: what seems to is a shape
/// that slides over it or lies in the valley, and the face pushes.
template <class Real>
Pusher pusherOf(const HullT<Real>& chain, Vec2T<Real> normal) {
    const Vec2T<Real> edge = chain.vertices[1] - chain.vertices[0];
    const bool atStart = dot(normal, edge) < Real(0);
    const Vec2T<Real> beside =
        atStart ? chain.vertices[0] - chain.vertices[2] : chain.vertices[3] - chain.vertices[1];
    const Real turn = atStart ? cross(beside, edge) : cross(edge, beside);
    if (!(turn > Real(0))) return Pusher::Face;
    const Real lean = dot(normal, beside);
    const bool between = atStart ? lean >= Real(0) : lean <= Real(0);
    return between ? Pusher::Segment : Pusher::Neighbour;
}

/// How high the lowest point of a hull is over the face of the neighbour that a normal leans to. Of
/// two faces the one over which that is more pushes, as of those of a solid.
template <class Real>
Real heightOverNeighbour(const HullT<Real>& chain, const HullT<Real>& b, Vec2T<Real> normal) {
    const bool atStart = dot(normal, chain.vertices[1] - chain.vertices[0]) < Real(0);
    const Vec2T<Real> vertex = chain.vertices[atStart ? 0 : 1];
    const Vec2T<Real> face = chain.normals[atStart ? 2 : 3];
    Real lowest = dot(face, b.vertices[0] - vertex);
    for (int j = 1; j < b.count; ++j) {
        lowest = minOf(lowest, dot(face, b.vertices[asIndex(j)] - vertex));
    }
    return lowest;
}

/// A chain segment against a disc, in the frame of the segment. The front of the chain falls into
/// the regions that are nearest to each face and to each vertex (Voronoi's): nothing else is
/// needed.
template <class Real>
ManifoldT<Real> chainAndDisc(const HullT<Real>& chain, const HullT<Real>& b, Vec2T<Real> center,
                             Real margin) {
    const Vec2T<Real> v1 = chain.vertices[0];
    const Vec2T<Real> v2 = chain.vertices[1];
    const Real height = dot(chain.normals[0], center - v1);
    if (height < Real(0) || height - b.radius > margin) return {};
    if (dot(center - v1, v2 - v1) < Real(0)) {
        if (dot(center - v1, v1 - chain.vertices[2]) < Real(0)) return {};
        return betweenPoints(v1, center, Real(0), b.radius, 0, 0, margin);
    }
    if (dot(center - v2, v2 - v1) > Real(0)) {
        if (dot(center - v2, chain.vertices[3] - v2) > Real(0)) return {};
        return betweenPoints(v2, center, Real(0), b.radius, 1, 0, margin);
    }
    ManifoldT<Real> m;
    m.normal = chain.normals[0];
    addPoint(m, center - height * m.normal, center, height - b.radius, Real(0), b.radius, 0, 0);
    return m;
}

/// What is beyond the ends of a face is the business of its neighbours.
template <class Real>
ManifoldT<Real> clipToFace(const HullT<Real>& chain, const HullT<Real>& b, Real margin) {
    const ManifoldT<Real> all = clipEdges(chain, 0, b, false, margin);
    const Vec2T<Real> along = perpLeft(chain.normals[0]);
    const Real extent = dot(chain.vertices[1] - chain.vertices[0], along);
    ManifoldT<Real> m;
    m.normal = all.normal;
    for (int i = 0; i < all.count; ++i) {
        const Real at = dot(all.points[i].point - chain.vertices[0], along);
        const Real slack = Real(2.0 * featureTolerance);
        if (at >= -slack && at <= extent + slack) m.points[m.count++] = all.points[i];
    }
    return m;
}

/// A chain segment against a hull of two or more vertices, in the frame of the segment.
template <class Real>
ManifoldT<Real> chainAndHull(const HullT<Real>& chain, const HullT<Real>& b, Real margin) {
    Vec2T<Real> sum;
    Real face{0};
    for (int j = 0; j < b.count; ++j) {
        const Vec2T<Real> w = b.vertices[asIndex(j)] - chain.vertices[0];
        const Real height = dot(chain.normals[0], w);
        sum += w;
        face = j == 0 ? height : minOf(face, height);
    }
    // Its middle decides on which side a hull is: one that came through from behind is let go.
    if (dot(chain.normals[0], sum) < Real(0)) return {};
    if (face > b.radius + margin) return {};
    const Axis<Real> axis = bestAxis(b, chain);
    if (axis.separation > b.radius + margin) return {};

    const bool flipped = axis.separation > face + Real(0.1 * featureTolerance);
    const Real separation = flipped ? axis.separation : face;
    if (separation > Real(featureTolerance) || b.count == 2) {
        const Nearest<Real> nearest = nearestPoints(chain, b);
        const Real across = Real(featureTolerance);
        const Real ahead = maxOf(separation, Real(0));
        if (nearest.twoVertices && nearest.squared > ahead * ahead + across * across) {
            const Pusher pusher = pusherOf(chain, nearest.pointB - nearest.pointA);
            if (pusher == Pusher::Neighbour) return {};
            if (pusher == Pusher::Face) return clipToFace(chain, b, margin);
            return betweenPoints(nearest.pointA, nearest.pointB, Real(0), b.radius, nearest.vertexA,
                                 nearest.vertexB, margin);
        }
    }
    if (!flipped) return clipToFace(chain, b, margin);
    const Vec2T<Real> normal = -b.normals[asIndex(axis.edge)];
    const Pusher pusher = pusherOf(chain, normal);
    if (pusher == Pusher::Segment) return clipEdges(b, axis.edge, chain, true, margin);
    if (pusher == Pusher::Neighbour && heightOverNeighbour(chain, b, normal) > face) return {};
    return clipToFace(chain, b, margin);
}

/// A manifold of B and A, in the frame of B, as that of A and B in the frame of A.
template <class Real>
ManifoldT<Real> turnedRound(ManifoldT<Real> m, const PoseT<Real>& relative) {
    m.normal = -rotate(relative.q, m.normal);
    for (ManifoldPointT<Real>& p : m.points) {
        p.point = transform(relative, p.point);
        p.feature = static_cast<std::uint16_t>(((p.feature & 0xff) << 8) | (p.feature >> 8));
    }
    return m;
}

/// Where at least one is a chain segment.
template <class Real>
ManifoldT<Real> withChain(const HullT<Real>& a, const HullT<Real>& b, const PoseT<Real>& relative,
                          Real margin) {
    if (a.oneSided && b.oneSided) return {};
    if (a.oneSided) {
        if (b.count > 1) return chainAndHull(a, moved(b, relative), margin);
        return chainAndDisc(a, b, transform(relative, b.vertices[0]), margin);
    }
    if (a.count == 1) {
        return turnedRound(chainAndDisc(b, a, untransform(relative, a.vertices[0]), margin),
                           relative);
    }
    const PoseT<Real> back{untransform(relative, Vec2T<Real>{}), {relative.q.c, -relative.q.s}};
    return turnedRound(chainAndHull(b, moved(a, back), margin), relative);
}

}  // namespace

template <class Real>
ManifoldT<Real> collide(const HullT<Real>& a, const HullT<Real>& b, const PoseT<Real>& relative,
                        Real margin) {
    if (a.oneSided || b.oneSided) return withChain(a, b, relative, margin);
    if (b.count == 1) {
        const Vec2T<Real> center = transform(relative, b.vertices[0]);
        if (a.count == 1) {
            return betweenPoints(a.vertices[0], center, a.radius, b.radius, 0, 0, margin);
        }
        return hullAndDisc(a, b, center, margin);
    }
    if (a.count == 1) {
        // In the frame of B, then turned back.
        return turnedRound(hullAndDisc(b, a, untransform(relative, a.vertices[0]), margin),
                           relative);
    }
    return hulls(a, moved(b, relative), margin);
}

template ManifoldT<float> collide(const HullT<float>&, const HullT<float>&, const PoseT<float>&,
                                  float);
template ManifoldT<double> collide(const HullT<double>&, const HullT<double>&, const PoseT<double>&,
                                   double);

}  // namespace huestep
