// The arrangement of algebraic curves by CGAL, counted as Imp counts: one JSON line for one scene.
//
// Input on stdin: "a b c d" (the box, rationals p/q), then for each curve the number of its terms and the terms
// "i j c" (c x^i y^j, an integer of any length). With the argument `box` the four lines that carry the sides of the box
// are part of the arrangement and what lies inside is counted; without it the arrangement of the plane is.
//
// CGAL is under the GPL (this package of it): it is linked here and nowhere else.

#include <algorithm>
#include <chrono>
#include <iostream>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <CGAL/Arr_algebraic_segment_traits_2.h>
#include <CGAL/Arrangement_2.h>
#include <CGAL/CORE_BigInt.h>

// Faster here than CGAL::Gmpz.
typedef CORE::BigInt Integer;

typedef CGAL::Arr_algebraic_segment_traits_2<Integer> Traits;
typedef CGAL::Arrangement_2<Traits> Arrangement;
typedef Traits::Curve_2 Curve;
typedef Traits::Polynomial_2 Polynomial;
typedef CGAL::Polynomial_traits_d<Polynomial> PolynomialTraits;
typedef std::vector<std::pair<CGAL::Exponent_vector, Integer>> Terms;

static Polynomial polynomial(const Terms& terms) {
    return PolynomialTraits::Construct_polynomial()(terms.begin(), terms.end());
}

static Integer integer(const std::string& text) {
    Integer value(0);
    bool negative = text[0] == '-';
    for (char c : text)
        if (c != '-') value = value * Integer(10) + Integer(c - '0');
    return negative ? Integer(0) - value : value;
}

// The line q v - p = 0, for v = x or y.
static Polynomial line(const std::string& at, int axis) {
    auto slash = at.find('/');
    Integer p = integer(at.substr(0, slash));
    Integer q = slash == std::string::npos ? Integer(1) : integer(at.substr(slash + 1));
    Terms terms;
    terms.emplace_back(axis == 0 ? CGAL::Exponent_vector(1, 0) : CGAL::Exponent_vector(0, 1), q);
    terms.emplace_back(CGAL::Exponent_vector(0, 0), Integer(0) - p);
    return polynomial(terms);
}

struct Union {
    std::map<const void*, const void*> up;
    const void* find(const void* a) {
        auto it = up.find(a);
        if (it == up.end()) { up[a] = a; return a; }
        if (it->second == a) return a;
        const void* root = find(it->second);
        up[a] = root;
        return root;
    }
    void join(const void* a, const void* b) { up[find(a)] = find(b); }
};

int main(int argc, char** argv) {
    bool box = argc > 1 && std::string(argv[1]) == "box";
    std::string side[4];
    for (auto& s : side) std::cin >> s;
    std::vector<Polynomial> input;
    for (long n; std::cin >> n;) {
        Terms terms;
        while (n-- > 0) {
            int i, j;
            std::string c;
            std::cin >> i >> j >> c;
            terms.emplace_back(CGAL::Exponent_vector(i, j), integer(c));
        }
        input.push_back(polynomial(terms));
    }

    Traits traits;
    auto start = std::chrono::steady_clock::now();
    auto construct = traits.construct_curve_2_object();
    std::vector<Curve> curves;
    for (const auto& p : input) curves.push_back(construct(p));
    std::vector<Curve> frame;
    if (box)
        for (int k = 0; k < 4; k++) frame.push_back(construct(line(side[k], k / 2)));
    std::vector<Curve> all = curves;
    all.insert(all.end(), frame.begin(), frame.end());
    Arrangement arr(&traits);
    CGAL::insert(arr, all.begin(), all.end());
    double ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();

    // The id of a curve is that of its polynomial, and so is the same for all its arcs.
    std::set<std::size_t> sides;
    for (const auto& c : frame) sides.insert(c.id());
    auto on_frame = [&](Arrangement::Halfedge_const_handle e) { return sides.count(e->curve().curve().id()) > 0; };

    std::set<const void*> inside;
    std::vector<Arrangement::Face_const_handle> stack;
    auto reach = [&](Arrangement::Face_const_handle f) {
        if (inside.insert(&*f).second) stack.push_back(f);
    };
    if (box) {
        // From the lower left corner to the right, the inside is to the left.
        for (auto v = arr.vertices_begin(); v != arr.vertices_end(); ++v) {
            if (v->is_isolated()) continue;
            std::set<std::size_t> here;
            auto first = v->incident_halfedges(), e = first;
            do here.insert(e->curve().curve().id()); while (++e != first);
            if (!here.count(frame[0].id()) || !here.count(frame[2].id())) continue;
            e = first;
            do {
                if (e->curve().curve().id() == frame[2].id() && e->direction() == CGAL::ARR_RIGHT_TO_LEFT) reach(e->twin()->face());
            } while (++e != first);
        }
    } else {
        for (auto f = arr.faces_begin(); f != arr.faces_end(); ++f)
            if (!f->is_fictitious()) reach(f);
    }
    Union parts;
    std::set<const void*> seen_edges, frame_points;
    std::map<const void*, int> degree;
    int isolated = 0, edges = 0;
    auto walk = [&](Arrangement::Ccb_halfedge_const_circulator first) {
        auto e = first;
        do {
            if (e->is_fictitious()) continue;
            if (on_frame(e)) {
                frame_points.insert(&*e->source());
                frame_points.insert(&*e->target());
                continue;
            }
            reach(e->twin()->face());
            const void* id = std::min<const void*>(&*e, &*e->twin());
            if (!seen_edges.insert(id).second) continue;
            edges++;
            parts.join(&*e->source(), &*e->target());
            degree[&*e->source()]++;
            degree[&*e->target()]++;
        } while (++e != first);
    };
    while (!stack.empty()) {
        auto f = stack.back();
        stack.pop_back();
        for (auto c = f->outer_ccbs_begin(); c != f->outer_ccbs_end(); ++c) walk(*c);
        for (auto c = f->inner_ccbs_begin(); c != f->inner_ccbs_end(); ++c) walk(*c);
        for (auto v = f->isolated_vertices_begin(); v != f->isolated_vertices_end(); ++v) isolated++;
    }
    // A point of a curve on the frame: an end of an edge there, or a point that only touches.
    int boundary = 0, ends = 0;
    std::map<int, int> degrees;
    // The list of vertices leaves out those at infinity.
    std::set<const void*> finite;
    for (auto v = arr.vertices_begin(); v != arr.vertices_end(); ++v) finite.insert(&*v);
    std::set<const void*> roots;
    for (const auto& [v, d] : degree) {
        // A vertex at infinity stands for one end of a branch; there it ends.
        roots.insert(parts.find(v));
        if (!finite.count(v)) ends++;
        else if (frame_points.count(v)) boundary++;
        else if (d != 2) degrees[d]++;
    }
    std::cout << "{\"faces\": " << inside.size() << ", \"components\": " << roots.size() + isolated
              << ", \"isolated\": " << isolated << ", \"degrees\": {";
    const char* comma = "";
    for (auto [d, n] : degrees) { std::cout << comma << "\"" << d << "\": " << n; comma = ", "; }
    std::cout << "}, \"boundary\": " << boundary << ", \"unbounded\": " << ends
              << ", \"V\": " << arr.number_of_vertices() << ", \"E\": " << arr.number_of_edges()
              << ", \"F\": " << arr.number_of_faces() << ", \"ms\": " << ms << "}" << std::endl;
}
