/// Lemke's method for linear complementarity problems: w = M z + q, w ≥ 0, z ≥ 0, w·z = 0 (Lemke
/// 1965; Cottle, Pang and Stone, "The Linear Complementarity Problem", 4.4). Dense, by pivots on a
/// tableau, with the lexicographic rule against cycles left out: tests perturb q instead.
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

namespace huestep::test {

class Lemke {
 public:
    using Matrix = std::vector<std::vector<double>>;

    /// None: it ended on a ray, without a solution.
    static std::optional<std::vector<double>> solve(const Matrix& m, const std::vector<double>& q) {
        return Lemke(m, q).run();
    }

 private:
    // Columns: w (n), z (n), the artificial z0, the right-hand side. Rows: w − M z − d z0 = q.
    Lemke(const Matrix& m, const std::vector<double>& q) : m_size(q.size()) {
        for (std::size_t i = 0; i < m_size; ++i) {
            std::vector<double> row(2 * m_size + 2, 0.0);
            row[i] = 1.0;
            for (std::size_t j = 0; j < m_size; ++j) row[m_size + j] = -m[i][j];
            row[2 * m_size] = -1.0;
            row[2 * m_size + 1] = q[i];
            m_rows.push_back(row);
            m_basis.push_back(i);
        }
    }

    void pivot(std::size_t row, std::size_t column) {
        const double by = m_rows[row][column];
        for (double& value : m_rows[row]) value /= by;
        for (std::size_t i = 0; i < m_size; ++i) {
            const double factor = m_rows[i][column];
            if (i == row || factor == 0.0) continue;
            for (std::size_t j = 0; j < m_rows[i].size(); ++j)
                m_rows[i][j] -= factor * m_rows[row][j];
        }
        m_basis[row] = column;
    }

    std::optional<std::vector<double>> run() {
        const std::size_t artificial = 2 * m_size;
        const std::size_t side = 2 * m_size + 1;
        std::size_t row = 0;
        for (std::size_t i = 1; i < m_size; ++i) {
            if (m_rows[i][side] < m_rows[row][side]) row = i;
        }
        if (m_rows[row][side] >= 0.0) return std::vector<double>(m_size, 0.0);
        std::size_t leaving = m_basis[row];
        pivot(row, artificial);
        for (int step = 0; step < 10'000; ++step) {
            if (leaving == artificial) return answer(side);
            const std::size_t entering = leaving < m_size ? leaving + m_size : leaving - m_size;
            double least = 0.0;
            bool found = false;
            for (std::size_t i = 0; i < m_size; ++i) {
                if (m_rows[i][entering] <= 1e-12) continue;
                const double ratio = m_rows[i][side] / m_rows[i][entering];
                // Of equal ones the artificial variable leaves first.
                const bool better = !found || ratio < least - 1e-12 ||
                                    (ratio < least + 1e-12 && m_basis[i] == artificial);
                if (!better) continue;
                found = true;
                least = ratio;
                row = i;
            }
            if (!found) return std::nullopt;
            leaving = m_basis[row];
            pivot(row, entering);
        }
        return std::nullopt;
    }

    [[nodiscard]] std::vector<double> answer(std::size_t side) const {
        std::vector<double> z(m_size, 0.0);
        for (std::size_t i = 0; i < m_size; ++i) {
            if (m_basis[i] >= m_size && m_basis[i] < 2 * m_size)
                z[m_basis[i] - m_size] = m_rows[i][side];
        }
        return z;
    }

    std::size_t m_size;
    Matrix m_rows;
    std::vector<std::size_t> m_basis;
};

}  // namespace huestep::test
