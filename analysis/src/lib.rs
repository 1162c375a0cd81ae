//! Ratings to ANOVA to report.
//!
//! A table of ratings becomes [`Observations`], those become a [`CellMatrix`] (subjects × cells), that
//! becomes an [`AnovaTable`] by the multivariate linear model: orthonormal contrasts for each set of within
//! factors, error and hypothesis sums of squares and products, type III or II. Any number of within and between
//! factors goes the same way.
//!
//! Conventions of this crate: a factor's levels stand in natural order (10K before 100K); effects are named
//! by their factors joined by `:`, between factors first; what does not exist is `None`, with a warning
//! that says why; a p value is an upper tail, never one minus a lower one.
//!
//! Not here: what the ratings mean and how they were taken.

mod anova;
mod anova_table;
mod apa;
mod between_model;
mod cell_matrix;
mod contrasts;
mod data_sections;
mod design;
mod error;
mod figure;
mod interval;
mod label_column;
mod mauchly_law;
mod natural_order;
mod observations;
mod page;
mod picture;
mod report;
mod results_text;
mod sections;
mod sidecar_facts;
mod sphericity;
mod study_analysis;
mod study_in_words;
mod study_ratings;
mod table_file;
mod tail;
mod text_table;

pub use anova::anova;
pub use anova_table::{AnovaTable, EffectRow};
pub use cell_matrix::{CellMatrix, Factor};
pub use design::Design;
pub use error::AnalysisError;
pub use interval::{CellSummary, cell_summaries};
pub use natural_order::natural_order;
pub use observations::Observations;
pub use report::{ReportSummary, report};
pub use sphericity::{Epsilons, Mauchly, Sphericity};
pub use study_ratings::Pilots;
pub use table_file::{anova_of_table, read_observations};
pub use tail::{f_tail, ln_f_tail, t_quantile};
