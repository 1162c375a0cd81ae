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

mod analysis_in_words;
mod anova;
mod anova_section;
mod anova_table;
mod apa;
mod asymptote;
mod axis;
mod between_model;
mod cell_figure;
mod cell_matrix;
mod cell_means;
mod chi_scale;
mod comparison;
mod contrasts;
mod data_sections;
mod design;
mod deviations;
mod document;
mod error;
mod factor_place;
mod figure;
mod figure_frame;
mod findings;
mod follow_up;
mod follow_up_sections;
mod fragility;
mod fragility_section;
mod interval;
mod label_column;
mod latex;
mod line_style;
mod markdown;
mod mauchly_law;
mod methods;
mod natural_order;
mod noncentral_t;
mod observations;
mod observer_figure;
mod observer_section;
mod p_adjustment;
mod page;
mod pdf;
mod pdf_font;
mod pdf_report;
mod pdf_text;
mod permutation;
mod picture;
mod picture_analysis;
mod picture_sections;
mod plain_figure;
mod plateau;
mod polynomial;
mod power;
mod power_design;
mod power_figure;
mod power_text;
mod predicted_figure;
mod prediction_section;
mod predictions;
mod printed_df;
mod ranks;
mod report;
mod report_age;
mod report_files;
mod results_text;
mod rich_text;
mod row_filter;
mod screening;
mod sections;
mod sidecar_facts;
mod sphericity;
mod studentized_range;
mod study_analysis;
mod study_in_words;
mod study_ratings;
mod table_analysis;
mod table_file;
mod table_report;
mod table_sections;
mod table_study;
mod tables_csv;
mod tail;
mod text_table;

pub use anova::anova;
pub use anova_table::{AnovaTable, EffectRow};
pub use asymptote::{
    Asymptote, AsymptoteSettings, Asymptotes, EquivalenceTest, Estimate, Outcome, ShapeFit,
    expanded_percentile_interval,
};
pub use cell_matrix::{CellMatrix, Factor};
pub use comparison::Comparison;
pub use design::{Decimal, Design};
pub use error::AnalysisError;
pub use follow_up::{FollowUp, FollowUpSettings, SimpleEffect};
pub use interval::{CellSummary, cell_summaries};
pub use natural_order::natural_order;
pub use observations::Observations;
pub use permutation::PermutationTest;
pub use plateau::{PlateauFit, linear_plateau};
pub use power::{AsymptoteWidth, EffectPower, Power, PowerPoint, PowerSettings, power};
pub use power_design::{EffectScale, PowerDesign};
pub use printed_df::{AllowedDesign, PrintedF};
pub use ranks::{AlignedRankEffect, Friedman};
pub use report::{ReportSummary, report, report_beside};
pub use report_age::{ReportAge, report_age};
pub use row_filter::{FilterKind, RowFilter};
pub use screening::{IntraclassCorrelation, Observer, ObserverModel, ObserverScreening, Opinion};
pub use sphericity::{Epsilons, Mauchly, Sphericity};
pub use study_ratings::Pilots;
pub use table_analysis::{AnalysisOptions, AsymptoteOption, DistributionFree, TableAnalysis};
pub use table_file::{anova_of_table, read_observations};
pub use table_report::report_of_tables;
pub use table_study::{TableStudy, folder_name};
pub use tail::{f_tail, ln_f_tail, t_quantile};
