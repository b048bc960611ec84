//! Solutions of a flat connection in closed form.
//!
//! In: functions of the outputs by their derivatives, `dw = G w`, whose second derivatives agree. A function that
//! depends on itself and on earlier ones alone is an exponential of an integral times an integral; two that depend on
//! each other are an exponential of a constant matrix, or of one that does not vary with the output that is integrated
//! along. Where an integral is not found, the solutions that need it are left out. Out: solutions, by the values of all
//! functions.

use std::collections::BTreeSet;

use crate::plant::Matrix;
use pebo_cas::number::rational::half;
use pebo_cas::tower::{Field, Obstacle};
use pebo_cas::{Expr, Function, Relation, Symbol};

use super::connection::{exponential, potential};
use crate::search::problem::Problem;

/// A flat connection.
pub(in crate::search) struct Flat<'a> {
    problem: &'a Problem<'a>,
    /// For each function and output, the factors of the functions in its derivative.
    slopes: Vec<Vec<Vec<Expr>>>,
}

/// Functions whose derivatives hold each other, with their own solutions.
struct Block {
    /// The values of the functions, a row each, and a column for each solution.
    values: Vec<Vec<Expr>>,
    /// The inverse matrix.
    inverse: Vec<Vec<Expr>>,
}

/// A matrix of two rows, as `mean I` and a matrix of trace zero.
struct TraceSplit {
    mean: Expr,
    diagonal: Expr,
    upper: Expr,
    lower: Expr,
}

impl<'a> Flat<'a> {
    pub(in crate::search) fn new(problem: &'a Problem<'a>, slopes: Vec<Vec<Vec<Expr>>>) -> Self {
        Self { problem, slopes }
    }

    /// Solutions, each by the values of all functions.
    pub(in crate::search) fn solutions(&self) -> Result<Vec<Vec<Expr>>, Obstacle> {
        let arena = self.problem.arena;
        let mut found: Vec<Vec<Expr>> = Vec::new();
        for functions in self.order() {
            let block = self.block(&functions)?;
            let mut kept = Vec::new();
            for mut solution in std::mem::take(&mut found) {
                let remainders = self.remainders(&functions, &solution)?;
                if remainders.iter().flatten().any(|e| !arena.is_zero(*e)) {
                    let Some(block) = &block else { continue };
                    let Some(factors) = self.varied(block, &remainders)? else { continue };
                    for (function, row) in functions.iter().zip(&block.values) {
                        solution[*function] = arena.dot(row, &factors);
                    }
                }
                kept.push(solution);
            }
            for column in 0..block.as_ref().map_or(0, |block| block.values.len()) {
                let mut own = vec![arena.zero(); self.slopes.len()];
                for (function, row) in functions.iter().zip(block.iter().flat_map(|block| &block.values)) {
                    own[*function] = row[column];
                }
                kept.push(own);
            }
            found = kept;
        }
        Ok(found)
    }

    /// The functions, each after the ones that it depends on, as far as there is such an order: alone, or two at once.
    fn order(&self) -> Vec<Vec<usize>> {
        let arena = self.problem.arena;
        let uses = |function: usize| {
            let of = self.slopes[function].iter();
            let others = (0..self.slopes.len()).filter(|other| *other != function);
            others.filter(|other| of.clone().any(|row| !arena.is_zero(row[*other]))).collect::<BTreeSet<usize>>()
        };
        let uses: Vec<BTreeSet<usize>> = (0..self.slopes.len()).map(uses).collect();
        let mut order = Vec::new();
        let mut placed = BTreeSet::new();
        loop {
            let open: Vec<usize> = (0..uses.len()).filter(|function| !placed.contains(function)).collect();
            let pairs = open.iter().flat_map(|f| open.iter().filter(move |g| f < g).map(move |g| vec![*f, *g]));
            let is_next = |functions: &Vec<usize>| {
                let within = |used: &usize| placed.contains(used) || functions.contains(used);
                functions.iter().all(|function| uses[*function].iter().all(within))
            };
            let Some(next) = open.iter().map(|f| vec![*f]).chain(pairs).find(is_next) else { return order };
            placed.extend(next.iter().copied());
            order.push(next);
        }
    }

    /// The solutions of functions that hold no others.
    fn block(&self, functions: &[usize]) -> Result<Option<Block>, Obstacle> {
        match *functions {
            [first, second] => match self.of_constant_matrix([first, second])? {
                Some(block) => Ok(Some(block)),
                None => self.along_one_output([first, second]),
            },
            _ => Ok(self.alone(functions[0])),
        }
    }

    /// The exponential of an integral.
    fn alone(&self, function: usize) -> Option<Block> {
        let own = self.problem.y.iter().copied().zip(self.slopes[function].iter().map(|row| row[function]));
        let unit = self.exponential(&own.collect::<Vec<_>>())?;
        let inverse = self.problem.arena.div(self.problem.arena.one(), unit);
        Some(Block { values: vec![vec![unit]], inverse: vec![vec![inverse]] })
    }

    /// Two functions whose derivatives are `d I + a J` times them, with the same constant J of trace zero for all
    /// outputs.
    fn of_constant_matrix(&self, pair: [usize; 2]) -> Result<Option<Block>, Obstacle> {
        let arena = self.problem.arena;
        let (mut common, mut turning, mut matrix) = (Vec::new(), Vec::new(), None);
        for (index, symbol) in self.problem.y.iter().enumerate() {
            let TraceSplit { mean, diagonal, upper, lower } = self.parts(pair, index);
            common.push((*symbol, mean));
            turning.push((*symbol, upper));
            if arena.is_zero(upper) {
                if !arena.is_zero(self.tidied(diagonal)?) || !arena.is_zero(lower) {
                    return Ok(None);
                }
                continue;
            }
            let ratios = [self.tidied(arena.div(diagonal, upper))?, self.tidied(arena.div(lower, upper))?];
            if ratios.iter().any(|e| arena.depends_on(*e, &self.problem.signals))
                || matrix.is_some_and(|known| known != ratios)
            {
                return Ok(None);
            }
            matrix = Some(ratios);
        }
        let Some([diagonal, lower]) = matrix else { return Ok(None) };
        let (Some(scale), Some(angle)) = (self.exponential(&common), potential(self.problem, &turning)) else {
            return Ok(None);
        };
        self.turned(scale, angle, [diagonal, arena.one(), lower])
    }

    /// Two functions whose derivatives by one output do not vary with it: they are an exponential along it, and the
    /// remaining equations are free of it.
    fn along_one_output(&self, pair: [usize; 2]) -> Result<Option<Block>, Obstacle> {
        let problem = self.problem;
        let arena = problem.arena;
        for (index, symbol) in problem.y.iter().enumerate() {
            let matrix = self.matrix(pair, index);
            let entries = matrix.entries();
            let varies = entries.iter().any(|e| arena.depends_on(*e, &[*symbol].into()));
            if varies || entries.iter().all(|e| arena.is_zero(*e)) {
                continue;
            }
            let y = arena.of_symbol(*symbol);
            let TraceSplit { mean, diagonal, upper, lower } = self.parts(pair, index);
            let scale = arena.call(Function::Exp, &[arena.mul(self.tidied(mean)?, y)]);
            let Some(outer) = self.turned(scale, y, [diagonal, upper, lower])? else { continue };
            let (values, inverse) = (Matrix::new(outer.values), Matrix::new(outer.inverse));
            // w = U v, dv = U^-1 (G U - dU) v
            let mut slopes = vec![Vec::new(), Vec::new()];
            for (other, symbol) in problem.y.iter().enumerate() {
                let moved = if other == index {
                    Matrix::zero(arena, 2, 2)
                } else {
                    let slope = values.derivative(arena, *symbol).map(|e| arena.neg(*e));
                    let moved = self.matrix(pair, other).mul(arena, &values).add(arena, &slope);
                    inverse.mul(arena, &moved).normal(arena, &problem.domain.facts)?
                };
                for (slopes, row) in slopes.iter_mut().zip(moved.rows()) {
                    slopes.push(row.clone());
                }
            }
            if slopes.iter().flatten().flatten().any(|e| arena.depends_on(*e, &[*symbol].into())) {
                continue;
            }
            let solutions = Flat::new(problem, slopes).solutions()?;
            if solutions.len() != 2 {
                continue;
            }
            let inner = Matrix::new(solutions).transpose();
            let Some(opposite) = inner.inverse(arena, &problem.domain.facts)? else { continue };
            let whole = values.mul(arena, &inner).rows().to_vec();
            return Ok(Some(Block { values: whole, inverse: opposite.mul(arena, &inverse).rows().to_vec() }));
        }
        Ok(None)
    }

    /// The matrix of two functions' derivatives by an output.
    fn matrix(&self, pair: [usize; 2], output: usize) -> Matrix {
        Matrix::build(2, 2, |row, column| self.slopes[pair[row]][output][pair[column]])
    }

    /// The same, its mean diagonal separate from the rest.
    fn parts(&self, pair: [usize; 2], output: usize) -> TraceSplit {
        let arena = self.problem.arena;
        let matrix = self.matrix(pair, output);
        let (first, second) = (matrix.at(0, 0), matrix.at(1, 1));
        TraceSplit {
            mean: arena.scale(arena.add(first, second), &half()),
            diagonal: arena.scale(arena.sub(first, second), &half()),
            upper: matrix.at(0, 1),
            lower: matrix.at(1, 0),
        }
    }

    /// A factor times `exp(a J)`, J of trace zero given by its diagonal, upper and lower entry.
    fn turned(&self, scale: Expr, angle: Expr, [diagonal, upper, lower]: [Expr; 3]) -> Result<Option<Block>, Obstacle> {
        let arena = self.problem.arena;
        let square = self.tidied(arena.add(arena.mul(diagonal, diagonal), arena.mul(upper, lower)))?;
        let Some([even, odd]) = self.series(square, angle) else { return Ok(None) };
        let of = |scale: Expr, odd: Expr| {
            let entry = |even: Expr, factor: Expr| arena.mul(scale, arena.add(even, arena.mul(odd, factor)));
            vec![
                vec![entry(even, diagonal), entry(arena.zero(), upper)],
                vec![entry(arena.zero(), lower), entry(even, arena.neg(diagonal))],
            ]
        };
        let inverse = of(arena.div(arena.one(), scale), arena.neg(odd));
        Ok(Some(Block { values: of(scale, odd), inverse }))
    }

    /// The even part of `exp(a J)`, and the factor of J in the odd one, where J^2 is this multiple of the identity.
    fn series(&self, square: Expr, angle: Expr) -> Option<[Expr; 2]> {
        let Problem { arena, domain, .. } = self.problem;
        if arena.is_zero(square) {
            return Some([arena.one(), angle]);
        }
        let pair = |square: Expr, even: Function, odd: Function| {
            let root = arena.sqrt(square);
            let angle = arena.mul(root, angle);
            [arena.call(even, &[angle]), arena.div(arena.call(odd, &[angle]), root)]
        };
        if domain.implies(arena, square, Relation::Positive) {
            return Some(pair(square, Function::Cosh, Function::Sinh));
        }
        let opposite = arena.neg(square);
        domain.implies(arena, opposite, Relation::Positive).then(|| pair(opposite, Function::Cos, Function::Sin))
    }

    /// The factors, functions of y, of a block's own solutions in one with these further terms in its derivatives.
    fn varied(&self, block: &Block, remainders: &[Vec<Expr>]) -> Result<Option<Vec<Expr>>, Obstacle> {
        let problem = self.problem;
        let mut factors = Vec::new();
        for row in &block.inverse {
            let mut slopes = Vec::new();
            for (index, symbol) in problem.y.iter().enumerate() {
                let rest: Vec<Expr> = remainders.iter().map(|rest| rest[index]).collect();
                slopes.push((*symbol, self.tidied(problem.arena.dot(row, &rest))?));
            }
            let Some(factor) = potential(problem, &slopes) else { return Ok(None) };
            factors.push(factor);
        }
        Ok(Some(factors))
    }

    /// For each of these functions, the contribution of the others to its derivatives.
    fn remainders(&self, functions: &[usize], solution: &[Expr]) -> Result<Vec<Vec<Expr>>, Obstacle> {
        let arena = self.problem.arena;
        let along = |row: &Vec<Expr>| {
            let others = row.iter().zip(solution).enumerate().filter(|(index, _)| !functions.contains(index));
            let terms = others.map(|(_, (factor, value))| arena.mul(*factor, *value));
            self.tidied(arena.sum(terms.collect::<Vec<Expr>>()))
        };
        functions.iter().map(|function| self.slopes[*function].iter().map(along).collect()).collect()
    }

    /// The exponential of a function with these derivatives.
    fn exponential(&self, slopes: &[(Symbol, Expr)]) -> Option<Expr> {
        Some(exponential(self.problem, potential(self.problem, slopes)?))
    }

    fn tidied(&self, expr: Expr) -> Result<Expr, Obstacle> {
        let field = Field::over(self.problem.arena, &self.problem.domain.facts, &[expr])?;
        Ok(field.show(&field.fraction(expr)?))
    }
}
